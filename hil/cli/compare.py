"""`stride compare`: two runs side by side."""

import json
import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

EPILOG = """[bold]Example[/bold]

stride walk --out dry

stride walk --backend mujoco --out mujoco

stride compare mujoco dry
"""


def compare(
    first: Annotated[Path, Argument(metavar="RUN_A", help="A run folder.")],
    second: Annotated[Path, Argument(metavar="RUN_B", help="Another one.")],
    out: Annotated[
        Path | None, Option(help="Picture to write.", show_default="RUN_B/compare-<RUN_A>.png")
    ] = None,
    as_json: Annotated[
        bool, Option("--json", help="Print the figures as JSON; the picture's path on stderr.")
    ] = False,
) -> None:
    """Compare two walks: steps, speed, step time, joints over the stride, loads, timing.

    Joints and loads are laid over each other by gait phase, after the first 5 s.
    """
    from hil.cli.table import number, print_rows
    from hil.compare import compare_walks, read_walk
    from hil.errors import InputError
    from hil.figures_compare import draw_comparison

    a, b = read_walk(first), read_walk(second)
    figures = compare_walks(a, b)
    path = out or second / f"compare-{a.name}.png"
    try:
        draw_comparison(a, b, path)
    except (OSError, ValueError) as error:
        raise InputError(f"--out {path}: {error}") from error
    if as_json:
        data = {
            figure.key: {
                "a": figure.first,
                "b": figure.second,
                "difference": figure.difference,
                "difference_pct": figure.difference_pct,
            }
            for figure in figures
        }
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
        sys.stderr.write(f"{path}\n")
        return
    rows = [
        (
            figure.key,
            number(figure.first),
            number(figure.second),
            number(figure.difference),
            number(figure.difference_pct),
        )
        for figure in figures
    ]
    print_rows(f"A: {a.label}, B: {b.label}", ("", "A", "B", "B − A", "%"), rows)
    sys.stdout.write(f"{path}\n")
