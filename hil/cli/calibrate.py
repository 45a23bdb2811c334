"""`stride calibrate`: what a robot file cannot know, measured by hand on a limp robot."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from typer import Exit, Option, Typer

from hil.cli.bringup_options import Ports, PortsFile, Robot
from hil.errors import InputError

if TYPE_CHECKING:
    from hil.bringup.calibrate_feet import FeetResult
    from hil.bringup.calibrating import Calibrating
    from hil.bringup.dialogue import Dialogue
    from hil.bringup.imu_mounting import Mounting
    from hil.bringup.lean_verdict import LeanEvidence

app = Typer(
    name="calibrate",
    no_args_is_help=True,
    rich_markup_mode="rich",
    help="Measure what a robot file cannot know, by hand on a limp robot; torque is never on.",
    epilog="[bold]Order[/bold]: joints, imu, feet, lean. Then: stride check.",
)

Out = Annotated[
    Path | None,
    Option(metavar="FILE.yaml", help="Calibration file.", show_default="the robot file's"),
]
ByHand = Annotated[
    bool,
    Option("--by-hand-of-emulator", help="The emulated robot's own hand does what is told."),
]


@app.command(
    epilog="""[bold]Examples[/bold]

stride calibrate joints my_robot.yaml                        all joints, zero in a jig

stride calibrate joints my_robot.yaml --zero stops           zero from the stops of the joints

stride calibrate joints my_robot.yaml --joint left_knee      one swapped servo
"""
)
def joints(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    out: Out = None,
    joint: Annotated[
        list[str] | None, Option(help="Only this joint; repeatable.", metavar="JOINT")
    ] = None,
    zero: Annotated[
        Literal["jig", "stops"],
        Option(help="Where the zero comes from: a jig, or the middle between two stops."),
    ] = "jig",
    sweep: Annotated[
        bool, Option("--sweep/--no-sweep", help="Record how far cables let the joints go.")
    ] = True,
    by_hand: ByHand = False,
) -> None:
    """Confirm every joint's sense, find its zero, sweep the range that its cables allow.

    Each joint is moved by hand as told. A joint that turns the wrong way, or another one that
    answers, is named, and nothing is written. Offsets live in the calibration file.
    Exit code 0: written; 1: refused; 2: bad input.
    """
    from hil.bringup.calibrate_joints import JointsRequest, calibrate_joints

    request = JointsRequest(tuple(joint or ()), zero, sweep)
    with _calibrating(robot, port, ports, out, by_hand, boards=False) as work:
        result = calibrate_joints(work, request)
        _print_joints(result.offsets, result.ranges)


def _print_joints(offsets: dict[str, float], ranges: dict[str, tuple[float, float]]) -> None:
    from math import degrees

    from hil.cli.bringup_tables import print_text

    rows = []
    for name, offset in offsets.items():
        low, high = ranges.get(name, (None, None))
        swept = "–" if low is None or high is None else f"{degrees(low):.1f} … {degrees(high):.1f}"
        rows.append((name, f"{degrees(offset):+.2f}", swept))
    print_text("Joints", ("joint", "offset [°]", "goes [°]"), rows)


@app.command(
    epilog="""[bold]Examples[/bold]

stride calibrate imu my_robot.yaml                    a board that is mounted square

stride calibrate imu my_robot.yaml --upside-down      and upside down
"""
)
def imu(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    out: Out = None,
    yaw: Annotated[
        Literal["square", "measured"],
        Option(help="Turn about the vertical: to the nearest right angle, or as it was tilted."),
    ] = "square",
    upside_down: Annotated[
        bool, Option("--upside-down", help="The board is mounted with its z axis down.")
    ] = False,
    by_hand: ByHand = False,
) -> None:
    """Find the gyro's bias and how the IMU sits: the torso upright, tilted forward, tilted left.

    A torso that moves, tilts that are too small or not forward and left, and a board that is
    upside down without being said so are refused, and nothing is written.
    Exit code 0: written; 1: refused; 2: bad input.
    """
    from hil.bringup.calibrate_imu import ImuRequest, calibrate_imu

    with _calibrating(robot, port, ports, out, by_hand) as work:
        mounting, bias = calibrate_imu(work, ImuRequest(yaw == "square", upside_down))
        _print_imu(mounting, bias.tolist())


def _print_imu(mounting: "Mounting", bias: list[float]) -> None:
    from math import degrees

    forward, left = (degrees(tilt) for tilt in mounting.tilts)
    quaternion = ", ".join(f"{part:+.4f}" for part in mounting.quaternion)
    rates = ", ".join(f"{degrees(rate):+.2f}" for rate in bias)
    sys.stdout.write(
        f"tilted {forward:.0f}° forward and {left:.0f}° left, "
        f"{90 - degrees(mounting.skew):.1f}° apart\n"
        f"mounting, sensor to base (w, x, y, z): {quaternion}; about the vertical "
        f"{degrees(mounting.yaw):+.1f}° as tilted\n"
        f"bias of the gyro [°/s]: {rates}\n"
    )


@app.command(
    epilog="""[bold]Examples[/bold]

stride calibrate feet my_robot.yaml --weight 1.0                 one weight, on every cell

stride calibrate feet my_robot.yaml --weight 0.5 --weight 2 --mass 2.71
"""
)
def feet(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    out: Out = None,
    weight: Annotated[
        list[float] | None,
        Option(metavar="KG", help="A known weight; repeatable.", show_default="1.0"),
    ] = None,
    mass: Annotated[
        float | None, Option(metavar="KG", help="Of the robot, weighed.", show_default="model's")
    ] = None,
    by_hand: ByHand = False,
) -> None:
    """Tare all load cells, scale them with known weights, and weigh the robot with them.

    Each weight goes onto every cell and the middle of both soles. Cells that do not answer, or
    others that answer, and weights that do not weigh what they should are named, and nothing is
    written. Exit code 0: written; 1: refused; 2: bad input.
    """
    from hil.bringup.calibrate_feet import FeetRequest, calibrate_feet

    request = FeetRequest(tuple(weight or (1.0,)), mass)
    with _calibrating(robot, port, ports, out, by_hand) as work:
        _print_feet(calibrate_feet(work, request))


def _print_feet(result: "FeetResult") -> None:
    from hil.cli.bringup_tables import print_text
    from hil.interface import CORNERS

    rows = [
        (f"{side} {corner.replace('_', ' ')}", f"{result.zeros[side][cell]:.0f}",
         f"{1 / fit.scale[cell]:+.1f}")
        for side, fit in result.fits.items()
        for cell, corner in enumerate(CORNERS)
    ]  # fmt: skip
    print_text("Load cells", ("cell", "zero [counts]", "counts a newton"), rows)
    left = ", ".join(f"{side} {fit.residual:.2f} N" for side, fit in result.fits.items())
    sys.stdout.write(f"left over by the fit (rms): {left}\n")
    sys.stdout.write(f"the robot weighs {result.weight_n:.1f} N on its cells\n")


@app.command(
    epilog="""[bold]Example[/bold]

stride calibrate lean my_robot.yaml     when joints, imu and feet are calibrated
"""
)
def lean(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    out: Out = None,
    by_hand: ByHand = False,
) -> None:
    """Lean the limp robot left, right and forward: IMU, joints and cells must agree.

    Finds mirrored joints, exchanged cells and feet, and a wrong mounting; who disagrees is named.
    The file remembers with which values they agreed.
    Exit code 0: they agree; 1: they do not; 2: bad input.
    """
    from hil.bringup.calibrate_lean import calibrate_lean

    with _calibrating(robot, port, ports, out, by_hand) as work:
        _print_lean(calibrate_lean(work))


def _print_lean(seen: "dict[str, LeanEvidence]") -> None:
    from math import degrees

    from hil.cli.bringup_tables import print_text

    rows = []
    for name, one in seen.items():
        axis = 1 if name == "forward" else 0
        legs = ", ".join(f"{side} {degrees(way[axis]):+.1f}" for side, way in one.joints.items())
        share = "–" if one.share is None else f"{100 * one.share:+.0f}"
        rows.append((name, f"{degrees(one.imu[axis]):+.1f}", legs, share))
    heads = ("lean", "IMU [°]", "joints of legs under load [°]", "load shifts [%]")
    print_text("They agree", heads, rows)


@contextmanager
def _calibrating(
    robot: str,
    port: list[str] | None,
    ports: Path | None,
    out: Path | None,
    by_hand: bool,
    *,
    boards: bool = True,
) -> "Iterator[Calibrating]":
    """Everything opened, and remarks and problems printed; the file is named at the end."""
    from hil.bringup.calibrating import RefusedError, calibrating
    from hil.bringup.check import finding_rows
    from hil.bringup.ports import robot_ports
    from hil.cli.bringup_tables import print_findings
    from hil.robot_files import load_robot

    description = load_robot(robot)
    found = robot_ports(description, port or [], ports)
    title = f"{description.name}: calibration"
    with _dialogue(ports, by_hand) as dialogue:
        try:
            with calibrating(description, found, out, dialogue, boards=boards) as work:
                yield work
                print_findings(title, finding_rows(work.inspection))
                sys.stdout.write(f"written: {work.file.path}\n")
        except RefusedError as error:
            print_findings(title, finding_rows(error.inspection))
            sys.stdout.write("nothing was written\n")
            raise Exit(error.exit_code) from error


@contextmanager
def _dialogue(ports: Path | None, by_hand: bool) -> "Iterator[Dialogue]":
    from hil.bringup.dialogue import HandDialogue, TerminalDialogue
    from hil.compose import virtual_hand
    from hil.run_folder import read_json

    terminal = TerminalDialogue()
    if not by_hand:
        yield terminal
        return
    control = read_json(ports).get("control") if ports is not None else None
    if control is None:
        raise InputError("--by-hand-of-emulator needs --ports FILE.json of stride emulate --json")
    with virtual_hand(Path(control)) as world:
        yield HandDialogue(terminal, lambda deed: world.do_by_hand(deed.as_request()))
