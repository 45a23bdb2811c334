"""`stride setup`: servos as the robot file and the driver want them."""

import json
import sys
from contextlib import AbstractContextManager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Exit, Option

from hil.cli.bringup_options import Ports, PortsFile, Robot, Yes
from hil.errors import InputError

if TYPE_CHECKING:
    from hil.bringup.setup import SetUp

EPILOG = """[bold]Examples[/bold]

stride setup my_robot.yaml --dry-run                    what would change, on all servos in place

stride setup my_robot.yaml --servo /dev/ttyUSB0 --joint left_knee    one new servo, alone

stride setup my_robot.yaml --replace left_knee          a new servo in the robot, others in place
"""

FEW = 6
"""More joints than these are counted, not named."""


def setup(
    robot: Robot,
    port: Ports = None,
    ports: PortsFile = None,
    joint: Annotated[
        list[str] | None, Option(help="Only this joint's servo; repeatable.", metavar="JOINT")
    ] = None,
    servo: Annotated[
        str | None,
        Option(metavar="PORT", help="The only servo on this port becomes that of --joint."),
    ] = None,
    replace: Annotated[
        str | None,
        Option(metavar="JOINT", help="The one servo with an unknown id or speed takes its place."),
    ] = None,
    dry_run: Annotated[bool, Option("--dry-run", help="Show what would change, and stop.")] = False,
    yes: Yes = False,
    as_json: Annotated[bool, Option("--json", help="Print the plans as JSON.")] = False,
) -> None:
    """Write ids, speed and settings into the servos' EEPROM, after showing all of them.

    Return delay, modes, limits, shutdown mask and the rest are made what the driver counts on,
    and read back. Servos that do not answer are left out: a robot may be built leg by leg.
    A swapped servo then needs: stride check, stride calibrate joints, stride jog.
    Exit code 0: all that answer are set up; 1: one could not be, or you said no; 2: bad input.
    """
    from hil.bringup.consent import require_consent

    with _set_up(robot, port or [], ports, joint or [], servo, replace) as work:
        if as_json:
            data = [asdict(plan) for plan in work.plans]
            sys.stdout.write(json.dumps(data, indent=2) + "\n")
        else:
            _print(work)
        if work.changing and not dry_run:
            count = len(work.changing)
            require_consent(f"Write this into the EEPROM of {count} servo(s)?", yes)
            work.apply(lambda plan: _say(f"{plan.joint}: written and read back", as_json))
            if servo is not None or replace is not None:
                _say("next: stride check, stride calibrate joints, stride jog", as_json)
        if work.blocked:
            raise Exit(1)


def _set_up(
    robot: str,
    port: list[str],
    ports: Path | None,
    joints: list[str],
    servo: str | None,
    replace: str | None,
) -> "AbstractContextManager[SetUp]":
    from hil.bringup.ports import robot_ports
    from hil.bringup.setup import replacement_set_up, robot_set_up, single_set_up
    from hil.robot_files import load_robot

    description = load_robot(robot)
    if servo is not None:
        if len(joints) != 1 or replace is not None:
            raise InputError("--servo PORT needs one --joint JOINT, and no --replace")
        return single_set_up(description, servo, joints[0])
    found = robot_ports(description, port, ports)
    if replace is None:
        return robot_set_up(description, found, joints)
    if joints:
        raise InputError("--replace JOINT names the joint itself: leave --joint out")
    return replacement_set_up(description, found, replace)


def _print(work: "SetUp") -> None:
    from hil.bringup.setup import is_absent
    from hil.cli.bringup_tables import print_text

    rows = [
        (plan.joint, str(plan.id), change.register, str(change.found), str(change.wanted),
         change.why)
        for plan in work.changing
        for change in plan.changes
    ]  # fmt: skip
    if rows:
        heads = ("joint", "id", "register", "is", "will be", "why")
        print_text("What will change", heads, rows)
    good = [plan.joint for plan in work.plans if not plan.changes and not plan.problem]
    if good:
        names = ", ".join(good) if len(good) <= FEW else f"{len(good)} servos"
        sys.stdout.write(f"as they should be: {names}\n")
    absent = [plan.joint for plan in work.plans if is_absent(plan)]
    if absent:
        sys.stdout.write(f"do not answer, left out: {', '.join(absent)}\n")
    for bus, why in work.left_out.items():
        sys.stdout.write(f"{bus}: {why}: left out\n")
    for plan in work.blocked:
        sys.stdout.write(f"{plan.joint} ({plan.bus} id {plan.id}): {plan.problem}\n")


def _say(text: str, as_json: bool) -> None:
    (sys.stderr if as_json else sys.stdout).write(text + "\n")
