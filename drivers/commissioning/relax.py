"""Torque off on everything that answers, and read back."""

from collections.abc import Iterable

from drivers.commissioning.line import ServoLine
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.search import BAUDS
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import BROADCAST_ID
from hil.bringup.facts import Relaxation, RelaxedServo
from hil.errors import BackendError


def relax_bench(bench: RobotBench) -> Relaxation:
    """Every servo on a robot's buses, whether the robot file knows it or not.

    All buses are told before any is asked, which takes seconds; a bus that is lost keeps nobody
    from the others.
    """
    result = Relaxation()
    result.not_reached |= {
        bus: bench.closed[bus] for bus in bench.description.buses if bus in bench.closed
    }
    for bus, line in bench.open_buses():
        try:
            _tell_all(line)
        except BackendError as error:
            result.not_reached[bus] = str(error)
    for bus, line in bench.open_buses():
        if bus in result.not_reached:
            continue
        try:
            result.servos += _asked(bench, bus, line)
        except BackendError as error:
            result.not_reached[bus] = str(error)
    return result


def _asked(bench: RobotBench, bus: str, line: ServoLine) -> list[RelaxedServo]:
    joints = {servo.id: f"{servo.joint} ({bus} id {servo.id})" for servo in bench.expected(bus)}
    return [
        RelaxedServo(joints.get(servo_id, f"{bus} id {servo_id}"), off)
        for servo_id, off in _read_back(line)
    ]


def relax_line(line: ServoLine) -> Relaxation:
    """Every servo on a port, at whatever speed. Raises BackendError for a port that is lost."""
    result = Relaxation()
    for baud in BAUDS:
        line.port.set_baud(baud)
        _tell_all(line)
    for baud in BAUDS:
        line.port.set_baud(baud)
        result.servos += [
            RelaxedServo(f"{line.port.url} id {servo_id} at {baud} baud", off)
            for servo_id, off in _read_back(line)
        ]
    return result


def _tell_all(line: ServoLine) -> None:
    line.tell(BROADCAST_ID, Register.TORQUE_ENABLE, 0)


def _read_back(line: ServoLine) -> Iterable[tuple[int, bool]]:
    """Ids that answer, and whether their torque is off; told again one by one until it is."""
    ids = sorted({packet.id for packet in line.ping_all().packets})
    for servo_id in ids:
        yield servo_id, line.power([servo_id]).off()
