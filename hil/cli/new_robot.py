"""`stride new-robot`: a robot folder from somebody's MJCF or URDF."""

import json
import re
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from hil.errors import InputError

if TYPE_CHECKING:
    from hil.new_robot.joints import Drive

EPILOG = """[bold]Examples[/bold]

stride new-robot biped.xml                   writes biped/biped.yaml and biped/biped.xml

stride new-robot robot.urdf --name mine      URDF too; meshes are looked for beside it

stride new-robot robot.urdf --similar        servos of minibiped's kind, scaled: a first walk

stride new-robot op3.xml --servo XM430-W350  every joint is one: straight to the dry run

stride walk biped/biped.yaml                 then: does it walk in MuJoCo?
"""


def new_robot(
    model: Annotated[Path, Argument(metavar="FILE.xml", help="MJCF or URDF of a biped.")],
    name: Annotated[
        str | None, Option(help="Name of the robot.", show_default="the file's")
    ] = None,
    out: Annotated[
        Path | None, Option(metavar="FOLDER", help="Where to write.", show_default="./NAME")
    ] = None,
    similar: Annotated[
        bool, Option("--similar", help="Torques, speeds and rotors scaled from minibiped's.")
    ] = False,
    servo: Annotated[
        str | None,
        Option(metavar="MODEL", help="All joints are this Dynamixel: its limits, ids assumed."),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Make a robot file of a model: legs, soles, limits, a gait; say what was not found.

    Nothing of the model is changed, and nothing is written over. Exit code 2: it is no biped that
    can be driven, and why.
    """
    from hil.new_robot.writing import new_robot as write

    called = _name(name, model)
    robot = write(model, called, out or Path(called), _drive(similar, servo))
    rows = [asdict(finding) for finding in robot.findings]
    if as_json:
        sys.stdout.write(json.dumps({"file": str(robot.file), "findings": rows}, indent=2) + "\n")
        return
    _print(called, rows)
    sys.stdout.write(f"{robot.file}\nnext: stride walk {robot.file}, then docs/new-robot.md\n")


def _drive(similar: bool, servo: str | None) -> "Drive":
    from hil.compose import servo_facts
    from hil.new_robot.joints import Drive
    from hil.new_robot.similar import P_GAIN

    if servo is None:
        return Drive(similar=similar)
    if similar:
        raise InputError("--similar and --servo are two answers to one question: give one")
    facts = servo_facts(servo)
    return Drive(
        servo=servo,
        torque=round(facts["stall_torque"], 3),
        speed=round(facts["no_load_speed"], 3),
        stiffness=round(P_GAIN * facts["position_stiffness"], 2),
        voltage=facts["voltage"],
    )


def _name(name: str | None, model: Path) -> str:
    """A name that a file, a folder and a table can have."""
    if name is None:
        return re.sub(r"[^A-Za-z0-9_-]+", "_", model.stem)
    if not re.fullmatch(r"[A-Za-z0-9_-]+", name):
        raise InputError(f"--name takes letters, digits, _ and -, got {name!r}")
    return name


def _print(name: str, rows: list[dict[str, str]]) -> None:
    from hil.cli.table import print_rows

    print_rows(name, ("", "", ""), [(row["kind"], row["what"], row["says"]) for row in rows])
