"""`stride emulate`: the virtual robot on pseudo-terminals, for any Dynamixel client."""

from typing import Annotated

from typer import Option

from hil.cli import options
from hil.fault_spec import gather_faults

EPILOG = """[bold]Examples[/bold]

stride emulate --json        one line with the ports; then point your own client at them

stride emulate --json --miswire mirror=left_knee > ports.json    a robot to be found wrong
"""


def emulate(
    robot: options.Robot = "minibiped",
    rate: options.Rate = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    fault: options.Faults = None,
    fault_plan: options.FaultPlan = None,
    miswire: Annotated[
        list[str] | None,
        Option(
            metavar="WHAT=VALUES",
            help="Put it together wrongly: swap=A,B, mirror=JOINT, "
            "offset=JOINT,DEG, cells=BOARD,CORNER,CORNER, imu=ROLL,PITCH,YAW, model=JOINT,MODEL, "
            "firmware=JOINT,VERSION, volts=V; repeatable.",
        ),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the ports as one line of JSON.")] = False,
) -> None:
    """Serve a virtual robot's servo buses and sensor boards until stopped with Ctrl-C.

    T = 0 of the faults is when it is ready; more can be injected on its control socket.
    """
    from hil.compose import serve_virtual

    faults = gather_faults(fault or (), fault_plan)
    serve_virtual(robot, rate, seed, tuple(overrides or ()), as_json, faults, miswire or ())
