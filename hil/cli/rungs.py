"""What `walk`, `stand` and `sit` have in common: ports, the question before torque, the report."""

import json
import sys
from collections.abc import Mapping
from pathlib import Path

from typer import Exit

from hil.request import RunRequest

QUESTIONS: Mapping[str, str] = {
    "stand": "will switch torque on and move to its standing pose in 2 s. Is it on the gantry, or "
    "held",
    "sit": "will switch torque on where it is and fold its legs in 3 s. Is nothing in their way",
    "hoisted": "will switch torque on and step in the air. Does it hang with its feet free",
    "walk": "will switch torque on, wait until its feet carry it, and walk. Is the rope slack but "
    "short",
}
"""By what the run does; asked of whoever starts a real robot."""


def live_ports(
    robot: str, overrides: tuple[str, ...], port: list[str] | None, file: Path | None
) -> dict[str, str]:
    """Ports from `--port` and `--ports`; empty where the robot file's count. Raises InputError."""
    if not port and file is None:
        return {}
    from hil.bringup.ports import robot_ports
    from hil.robot_files import load_robot

    return robot_ports(load_robot(robot, overrides), port or [], file)


def conduct(request: RunRequest, *, yes: bool, as_json: bool) -> None:
    """Run what was asked for; a real robot only after a yes.

    Raises Exit(1) if it had to stop, or if a jump did not end standing.

    Parts that take long to import come last: a wrong option is answered at once.
    """
    from hil.bringup.consent import require_consent
    from hil.compose import build
    from hil.run import run

    session = build(request)
    rung = "hoisted" if request.hoisted else request.activity
    if request.live:
        require_consent(
            f"{session.description.name} {QUESTIONS[rung]}, and a hand on the switch in the servo "
            "supply?",
            yes,
        )
    result = run(session)
    if as_json:
        sys.stdout.write(json.dumps(result.report, indent=2) + "\n")
        sys.stderr.write(f"{result.folder}\n")
    else:
        from hil.cli.table import print_report

        print_report(result.report, "" if rung == "walk" else rung)
        sys.stdout.write(f"{result.folder}\n")
    if any(fault["reaction"] != "none" for fault in result.report["faults"]):
        raise Exit(1)
    if result.report.get("landed_standing") is False:
        raise Exit(1)
