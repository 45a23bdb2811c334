"""Everything that bring-up commands use of the drivers, under one name."""

from pathlib import Path

from drivers.calibration import RobotCalibration, load_calibration
from drivers.commissioning.board_inspection import inspect_boards
from drivers.commissioning.calibration_file import CalibrationFile
from drivers.commissioning.inspection import inspect_servos, joint_angle
from drivers.commissioning.line import ServoLine
from drivers.commissioning.one_servo import OneServo, find_servo
from drivers.commissioning.port_names import found_ports, latency_timer_ms
from drivers.commissioning.relax import relax_bench, relax_line
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.sampling import RobotSampler
from drivers.commissioning.search import BAUDS, check_bauds, search_line
from drivers.commissioning.set_up import SILENT, apply_plan, plan_new, plan_replacement, plan_robot
from drivers.commissioning.settings import RegisterImage
from drivers.commissioning.watch import Watch
from drivers.commissioning.watchdog_trial import measure_watchdog
from drivers.dynamixel.port import Port
from hil.description import RobotDescription
from hil.interface import Clock

__all__ = [
    "SILENT",
    "CalibrationFile",
    "OneServo",
    "RegisterImage",
    "RobotBench",
    "RobotCalibration",
    "RobotSampler",
    "ServoLine",
    "Watch",
    "apply_plan",
    "calibration_of",
    "check_bauds",
    "find_servo",
    "found_ports",
    "inspect_boards",
    "inspect_servos",
    "joint_angle",
    "latency_timer_ms",
    "measure_watchdog",
    "open_line",
    "plan_new",
    "plan_replacement",
    "plan_robot",
    "relax_bench",
    "relax_line",
    "search_line",
]


def open_line(url: str, clock: Clock) -> ServoLine:
    """A port of which nothing is known. Raises PortError."""
    return ServoLine(Port(url, url, BAUDS[0]), clock)


def calibration_of(description: RobotDescription) -> RobotCalibration | None:
    """What the robot file names; none if it names none, or if there is no such file yet.

    Raises InputError or DescriptionError.
    """
    path = Path(description.file).parent / (description.calibration or "")
    return load_calibration(path) if description.calibration and path.exists() else None
