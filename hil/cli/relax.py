"""`stride relax`: torque off, everywhere."""

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Exit, Option

from hil.cli.bringup_options import Ports, PortsFile, Yes

if TYPE_CHECKING:
    from hil.bringup.facts import Relaxation

EPILOG = """[bold]Examples[/bold]

stride relax my_robot.yaml --yes      every servo of a robot; it goes limp: hold it

stride relax /dev/ttyUSB0 --yes       every servo on a port, at whatever speed
"""


def relax(
    target: Annotated[
        str, Argument(metavar="ROBOT|PORT", help="A robot, its YAML file, or one serial port.")
    ],
    port: Ports = None,
    ports: PortsFile = None,
    yes: Yes = False,
    as_json: Annotated[bool, Option("--json", help="Print what answered as JSON.")] = False,
) -> None:
    """Switch torque off on every servo that answers, and read it back. It asks first.

    A broadcast to all buses goes out before anything is waited for. Bus watchdogs that tripped
    are cleared. Exit code 0: every servo that answers is off; 1: one is not, none answers,
    or a bus could not be reached; 2: bad input.
    """
    from hil.bringup.consent import require_consent
    from hil.bringup.relax import relax as switch_off

    require_consent(f"{target} will go limp and fall if nobody holds it. Switch torque off?", yes)
    result = switch_off(target, port or [], ports)
    if as_json:
        sys.stdout.write(json.dumps(asdict(result), indent=2) + "\n")
    else:
        for servo in result.servos:
            text = "torque off, read back" if servo.off else "TORQUE OFF IS NOT READ BACK"
            sys.stdout.write(f"{servo.where}: {text}\n")
    if not result.complete:
        sys.stderr.write(f"stride: {_what_is_left(target, result)}\n")
        raise Exit(1)


def _what_is_left(target: str, result: "Relaxation") -> str:
    still = [servo.where for servo in result.servos if not servo.off]
    parts = [f"cut the servo power by hand: {', '.join(still)}"] if still else []
    parts += [f"{bus} was not reached: {why}" for bus, why in result.not_reached.items()]
    if not result.servos:
        parts.append(f"{target}: no servo answers: is the supply off?")
    return "; ".join(parts)
