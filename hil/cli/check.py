"""`stride check`: everything that can be asked of a limp robot before torque goes on."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Exit, Option

from hil.cli.bringup_options import Ports, PortsFile, Robot, Yes

if TYPE_CHECKING:
    from hil.bringup.check import Check
    from hil.description import RobotDescription

EPILOG = """[bold]Examples[/bold]

stride check my_robot.yaml                        before every session

stride check my_robot.yaml --description          no hardware: what does the file still lack?

stride check my_robot.yaml --after-fall           hang it up first, legs straight down

stride check my_robot.yaml --watchdog left_knee   one hanging joint: does silence stop it?

stride check my_robot.yaml --bundle report.zip    what a hardware report needs
"""

WATCHDOG_EFFORT = 0.3
"""Share of full duty with which a joint holds its place meanwhile."""


def check(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    rate: Annotated[
        int | None, Option(help="Control rate to check the buses for.", show_default="robot's")
    ] = None,
    after_fall: Annotated[
        bool, Option("--after-fall", help="Compare the hanging legs too: has a horn slipped?")
    ] = False,
    description_only: Annotated[
        bool,
        Option("--description", help="Only the robot file: what is missing, for which rung."),
    ] = False,
    watchdog: Annotated[
        str | None,
        Option(metavar="JOINT", help="Only measure how much silence stops this free joint."),
    ] = None,
    bundle: Annotated[
        Path | None, Option(metavar="FILE.zip", help="Pack findings, registers and files.")
    ] = None,
    yes: Yes = False,
    as_json: Annotated[bool, Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Look at ports, servos, registers, supply, pose and boards; all problems in one table.

    Torque stays off and nothing is written, but with --watchdog. Exit code 0: no problem;
    1: problems; 2: bad input.
    """
    from rich.console import Console

    from hil.bringup.check import Check, finding_rows, write_bundle
    from hil.bringup.ports import robot_ports
    from hil.robot_files import load_robot

    if description_only:
        _describe(robot, as_json)
        return
    description = load_robot(robot)
    found = robot_ports(description, port or [], ports)
    if watchdog is not None:
        _measure(description, found, watchdog, yes, as_json)
        return
    work = Check(description, found, rate or description.defaults.rate_hz)
    with Console(stderr=True).status("asking everybody"):
        inspection = work.run(after_fall)
    if bundle is not None:
        write_bundle(work, bundle)
    if as_json:
        data = {"looked_at": inspection.looked_at, "findings": finding_rows(inspection)}
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
    else:
        _print(work)
        if bundle is not None:
            sys.stdout.write(f"{bundle}\n")
    if inspection.problems:
        raise Exit(1)


def _describe(robot: str, as_json: bool) -> None:
    from dataclasses import asdict

    from hil.cli.bringup_tables import print_text
    from hil.description_gaps import description_gaps

    gaps = description_gaps(robot)
    rows = [asdict(gap) for gap in gaps]
    if as_json:
        sys.stdout.write(json.dumps({"gaps": rows}, indent=2) + "\n")
    elif not gaps:
        sys.stdout.write(f"{robot}: nothing is missing\n")
    else:
        heads = ("needed for", "where", "what", "what to do")
        print_text(
            f"{robot}: {len(gaps)} thing(s) missing",
            heads,
            [(gap.needed_for, gap.where, gap.what, gap.advice) for gap in gaps],
        )
    if gaps:
        raise Exit(1)


def _print(work: "Check") -> None:
    from hil.bringup.check import finding_rows
    from hil.cli.bringup_tables import print_findings

    inspection = work.inspection
    count, looked = len(inspection.problems), inspection.looked_at
    print_findings(f"{work.description.name}: before arming", finding_rows(inspection))
    verdict = f"{count} problem(s): do not arm" if count else "no problem"
    sys.stdout.write(f"{looked} questions, {verdict}\n")


def _measure(
    description: "RobotDescription", ports: dict[str, str], joint: str, yes: bool, as_json: bool
) -> None:
    from dataclasses import asdict

    from hil.bringup.check import watchdog_trip
    from hil.bringup.consent import require_consent
    from hil.identify import joint_index

    joint_index(description.joint_names, joint)
    require_consent(
        f"{joint} will hold its place with torque on for a few seconds, at "
        f"{100 * WATCHDOG_EFFORT:.0f} % of its duty. Does it hang free?",
        yes,
    )
    trip = watchdog_trip(description, ports, joint, WATCHDOG_EFFORT)
    if as_json:
        sys.stdout.write(json.dumps(asdict(trip), indent=2) + "\n")
        return
    torque = "stayed on: it held its place" if trip.torque_stays else "went off by itself"
    sys.stdout.write(
        f"{joint}: bore {trip.longest_quiet_ms:.1f} ms of silence, was stopped by "
        f"{trip.shortest_trip_ms:.1f} ms (nominal {trip.nominal_ms:.0f} ms, {trip.trials} trials); "
        f"torque {torque}\ntorque off, read back\n"
    )
