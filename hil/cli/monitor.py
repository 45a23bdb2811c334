"""`stride monitor`: a robot's state, live, without touching it."""

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

from typer import Option

from hil.cli.bringup_options import Ports, PortsFile, Robot

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import RenderableType

    from hil.bringup.facts import JointReading, RobotReading

EPILOG = """[bold]Examples[/bold]

stride monitor my_robot.yaml                      until Ctrl-C

stride monitor my_robot.yaml --json --duration 10 > state.jsonl    one object a line
"""


def monitor(
    robot: Robot = "minibiped",
    port: Ports = None,
    ports: PortsFile = None,
    duration: Annotated[
        float | None, Option(min=0.0, help="In s.", show_default="until Ctrl-C")
    ] = None,
    rate: Annotated[float, Option(min=0.1, max=50.0, help="Looks a second, at most.")] = 5.0,
    as_json: Annotated[bool, Option("--json", help="Print one JSON object a look.")] = False,
) -> None:
    """Show joints, feet and IMU as they are. Only reads leave the computer: torque is untouched.

    Joints that do not answer are shown as absent and asked again every second. Angles use the
    calibration that the robot file names; without one, zeros count as 0 and cells show counts.
    """
    from hil.bringup.monitor import watch
    from hil.bringup.ports import robot_ports
    from hil.robot_files import load_robot

    description = load_robot(robot)
    readings = watch(description, robot_ports(description, port or [], ports), rate, duration)
    if as_json:
        for time_s, reading in readings:
            data = {"time_s": round(time_s, 3), **_rounded(asdict(reading))}
            sys.stdout.write(json.dumps(data) + "\n")
            sys.stdout.flush()
        return
    _show(readings, description.name)


def _show(readings: "Iterator[tuple[float, RobotReading]]", name: str) -> None:
    """On a terminal the table stays and changes; elsewhere only the last one is printed."""
    from rich.live import Live

    from hil.cli.table import page_console

    console = page_console()
    if not console.is_terminal:
        tables = [_table(reading, time_s, name) for time_s, reading in readings]
        console.print(tables[-1] if tables else "")
        return
    with Live(console=console, auto_refresh=False) as live:
        for time_s, reading in readings:
            live.update(_table(reading, time_s, name), refresh=True)


def _table(reading: "RobotReading", time_s: float, name: str) -> "RenderableType":
    from rich.box import SIMPLE_HEAD
    from rich.console import Group
    from rich.markup import escape
    from rich.table import Table

    title = f"{name}, {time_s:.1f} s: torque is not touched"
    joints = Table(title=title, title_justify="left", header_style="bold", box=SIMPLE_HEAD)
    for head in ("joint", "id", "[°]", "[°/s]", "[°C]", "[V]", "torque", "error", "age [ms]"):
        left = head in ("joint", "error")
        joints.add_column(escape(head), justify="left" if left else "right", no_wrap=left)
    for joint in reading.joints:
        style = "dim" if joint.position_deg is None else "bold red" if joint.error else None
        joints.add_row(joint.joint, str(joint.id), *_cells(joint), style=style)
    boards = Table(header_style="bold", box=SIMPLE_HEAD)
    for head in ("board", "values", "invalid", "age [ms]"):
        boards.add_column(escape(head), justify="right" if head.startswith("age") else "left")
    for board in reading.boards:
        decimals = 0 if board.unit == "counts" else 1
        values = ", ".join(f"{key} {value:.{decimals}f}" for key, value in board.values.items())
        age = "–" if board.age_ms is None else f"{board.age_ms:.0f}"
        text = f"{values} {board.unit}".strip() or "absent"
        boards.add_row(board.board, text, ", ".join(board.invalid) or "none", age)
    return Group(joints, boards)


def _cells(joint: "JointReading") -> tuple[str, ...]:
    if joint.position_deg is None:
        return ("–", "–", "–", "–", "–", "absent", "–")
    return (
        f"{joint.position_deg:+.1f}",
        f"{joint.velocity_dps:+.0f}",
        str(joint.temperature_c),
        f"{joint.voltage_v:.1f}",
        "ON" if joint.torque_on else "off",
        joint.error or "none",
        f"{joint.age_ms:.0f}",
    )


def _rounded(value: Any) -> Any:
    """Floats with three decimals, whatever they are in."""
    if isinstance(value, float):
        return round(value, 3)
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return value
