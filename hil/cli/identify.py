"""`stride identify`: the constants of a joint's servo, from moving it."""

import json
import sys
from math import isfinite, pi
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option

from hil.cli import options
from hil.request import RunRequest

if TYPE_CHECKING:
    from hil.identify import Identified, Rig

EPILOG = """[bold]Examples[/bold]

stride identify left_knee                       a virtual servo, beside what it really is

stride identify left_knee right_knee --seed 3   another virtual robot, both knees

stride identify left_knee --robot my_robot.yaml --live    a real one, hanging with its feet free
"""
UNITS = {
    "torque_constant": "N·m/A",
    "resistance": "Ω",
    "armature": "kg·m²",
    "friction": "N·m",
    "viscous": "N·m·s/rad",
    "delay": "ms",
    "backlash": "deg",
}
"""Unit in which each constant is printed."""
FACTORS = {"delay": 1e3, "backlash": 180 / pi}
"""From SI to the printed unit, where they differ."""


def identify(
    joints: Annotated[list[str], Argument(metavar="JOINT...", help="Joints to identify.")],
    robot: Annotated[str, Option(help="A robot that ships, or a YAML file.")] = "minibiped",
    live: Annotated[bool, Option("--live", help="Move the real robot's joint.")] = False,
    rate: options.Rate = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    out: Annotated[
        Path | None,
        Option(help="Calibration file to write.", show_default="robot's, or NAME-calibration.yaml"),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the constants as JSON.")] = False,
) -> None:
    """Sweep, step and shake one joint, and fit its servo: constants with uncertainty.

    The robot hangs with its feet free and everything else holds the start pose; torque is off
    afterwards. The result goes into the calibration file, where the gain mapping finds it.
    """
    request = RunRequest.checked(
        robot=robot,
        backend="bus",
        live=live,
        rate_hz=rate,
        seed=seed,
        overrides=tuple(overrides or ()),
    )
    found = []
    for joint in joints:
        rig, identified, path = _identify(request, joint, out)
        found.append(_as_json(identified, rig))
        if not as_json:
            _print(identified, rig)
    if as_json:
        sys.stdout.write(json.dumps(found, indent=2) + "\n")
        sys.stderr.write(f"{path}\n")
    else:
        sys.stdout.write(f"{path}\n")


def _identify(request: RunRequest, joint: str, out: Path | None) -> "tuple[Rig, Identified, Path]":
    from rich.console import Console
    from rich.progress import Progress

    from hil.compose import servo_rig
    from hil.identify import identify as move_and_fit

    rig = servo_rig(request, joint)
    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(joint, total=None)

        def show(done: int, total: int) -> None:
            if done % 30 == 0:
                progress.update(task, completed=done, total=total)

        identified = move_and_fit(rig, joint, show)
    path = out or _calibration_file(rig)
    rig.keep(path, identified)
    return rig, identified, path


def _calibration_file(rig: "Rig") -> Path:
    """The robot's own, beside its description; else one by its name in this folder."""
    description = rig.session.description
    if description.calibration is not None:
        return Path(description.file).parent / description.calibration
    return Path(f"{description.name}-calibration.yaml")


def _print(identified: "Identified", rig: "Rig") -> None:
    from hil.cli.table import print_rows

    fit, rows = identified.fit, []
    for name, unit in UNITS.items():
        one, factor = getattr(fit, name), FACTORS.get(name, 1.0)
        known = rig.hidden.get(name)
        rows.append(
            (
                name.replace("_", " "),
                _number(factor * one.value),
                f"± {_number(factor * one.deviation)}",
                "" if known is None else _number(factor * known),
                unit,
            )
        )
    free = fit.free_divisor
    known = rig.hidden.get("gain_divisor")
    rows.append(
        (
            "gain divisor",
            f"{fit.gain_divisor:.0f}",
            f"by the load {_number(free.value)} ± {_number(free.deviation)}",
            "" if known is None else f"{known:.0f}",
            "",
        )
    )
    title = f"{identified.joint}: torque left over {fit.torque_residual:.3f} N·m rms"
    print_rows(title, ("", "found", "deviation", "true" if rig.hidden else "–", ""), rows)


def _number(value: float) -> str:
    return f"{value:.4g}" if isfinite(value) else "–"


def _as_json(identified: "Identified", rig: "Rig") -> dict[str, Any]:
    return {
        "joint": identified.joint,
        **identified.fit.as_dict(),
        "true": rig.hidden,
        "ticks_lost": identified.ticks_lost,
    }
