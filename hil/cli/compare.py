"""`stride compare`: two runs side by side, and why they differ."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from typer import Argument, Option

if TYPE_CHECKING:
    from hil.after.comparison import Comparison
    from hil.compare import Figure, Walk
    from hil.recording import Recording

T = TypeVar("T")
Pair = tuple[T, T]

EPILOG = """[bold]Example[/bold]

stride walk --out before

stride walk --out after --set "plant.joint_friction={left_knee: 0.3}"

stride compare before after
"""


def compare(
    first: Annotated[Path, Argument(metavar="RUN_A", help="A run folder.")],
    second: Annotated[Path, Argument(metavar="RUN_B", help="Another one.")],
    out: Annotated[
        Path | None, Option(help="Picture to write.", show_default="RUN_B/compare-<RUN_A>.png")
    ] = None,
    as_json: Annotated[
        bool, Option("--json", help="Print it all as JSON; the pictures' paths on stderr.")
    ] = False,
) -> None:
    """Compare two runs: walking figures, every joint, and the likely cause where one stands out.

    Joints are laid over each other by gait phase. Delay, gain, friction, rotor inertia, joint zero
    and battery are measured in both recordings; what differs by more than two walks of one robot
    do is named with its number (docs/after-a-run.md). A second picture, `-joints`, shows them.
    """
    from hil.errors import InputError
    from hil.recording import read_recording

    names = (first.resolve().name, second.resolve().name)
    recordings = (read_recording(first), read_recording(second))
    walks = _walks(names, recordings)
    comparison, why_not = _joints(names, recordings)
    if walks is None and comparison is None:
        raise InputError(f"neither a walk to compare nor joints: {why_not}")
    path = out or second / f"compare-{names[0]}.png"
    pictures = _draw(walks, comparison, names, path)
    if as_json:
        data = _as_dict(walks, comparison, why_not)
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
        sys.stderr.writelines(f"{picture}\n" for picture in pictures)
        return
    if walks is not None:
        _print_figures(*walks)
    if comparison is not None:
        from hil.cli.joint_table import print_comparison

        print_comparison(comparison, names)
    else:
        sys.stdout.write(f"no causes looked for: {why_not}\n")
    sys.stdout.writelines(f"{picture}\n" for picture in pictures)


def _walks(names: Pair[str], recordings: "Pair[Recording]") -> "Pair[Walk] | None":
    """Both walks; none where a run has none."""
    from hil.compare import walk_of

    first, second = (walk_of(*run) for run in zip(names, recordings, strict=True))
    return None if first is None or second is None else (first, second)


def _joints(
    names: Pair[str], recordings: "Pair[Recording]"
) -> "tuple[Comparison | None, str | None]":
    """The comparison joint by joint, or why there is none."""
    from hil.after.comparison import compare_runs
    from hil.after.recorded import run_of
    from hil.errors import InputError

    try:
        first, second = (run_of(*run) for run in zip(names, recordings, strict=True))
        return compare_runs(first, second), None
    except InputError as error:
        return None, str(error)


def _draw(
    walks: "Pair[Walk] | None",
    comparison: "Comparison | None",
    names: Pair[str],
    path: Path,
) -> list[Path]:
    """Write the pictures that there is something for."""
    from hil.after.figures_joints import draw_joints
    from hil.figures_compare import draw_comparison

    pictures = []
    if walks is not None:
        a, b = walks
        pictures.append(_written(path, lambda place: draw_comparison(a, b, place)))
    if comparison is not None and comparison.curves.aligned != "mean":
        both, beside = comparison, path.with_name(f"{path.stem}-joints{path.suffix}")
        pictures.append(_written(beside, lambda place: draw_joints(both, names, place)))
    return pictures


def _written(path: Path, draw: Callable[[Path], None]) -> Path:
    from hil.errors import InputError

    try:
        draw(path)
    except (OSError, ValueError) as error:
        raise InputError(f"--out {path}: {error}") from error
    return path


def _as_dict(
    walks: "Pair[Walk] | None", comparison: "Comparison | None", why_not: str | None
) -> dict[str, Any]:
    from hil.compare import compare_walks

    figures: list[Figure] = [] if walks is None else compare_walks(*walks)
    data: dict[str, Any] = {
        figure.key: {
            "a": figure.first,
            "b": figure.second,
            "difference": figure.difference,
            "difference_pct": figure.difference_pct,
        }
        for figure in figures
    }
    return data | {
        "comparison": None if comparison is None else comparison.as_dict(),
        "no_causes_because": why_not,
    }


def _print_figures(a: "Walk", b: "Walk") -> None:
    from hil.cli.table import print_rows
    from hil.compare import compare_walks
    from hil.report_words import number

    rows = [
        (
            figure.key,
            number(figure.first),
            number(figure.second),
            number(figure.difference),
            number(figure.difference_pct),
        )
        for figure in compare_walks(a, b)
    ]
    print_rows(f"A: {a.label}, B: {b.label}", ("", "A", "B", "B − A", "%"), rows)
