"""`stride emulate`: the virtual robot on pseudo-terminals, for any Dynamixel client."""

from typing import Annotated

from typer import Argument, Option

EPILOG = """[bold]Example[/bold]

stride emulate --json        one line with the ports; then point your own client at them
"""


def emulate(
    robot: Annotated[str, Argument(help="A robot that ships, or a YAML file.")] = "minibiped",
    rate: Annotated[int | None, Option(help="Rate that the physics grid fits, in Hz.")] = None,
    seed: Annotated[int, Option(help="Draws sensor noise, biases and latency jitter.")] = 0,
    overrides: Annotated[
        list[str] | None,
        Option("--set", metavar="KEY=VALUE", help="Change a value of the robot file; repeatable."),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the ports as one line of JSON.")] = False,
) -> None:
    """Serve a virtual robot's servo buses and sensor boards until stopped with Ctrl-C."""
    from hil.compose import serve_virtual

    serve_virtual(robot, rate, seed, tuple(overrides or ()), as_json)
