"""From a robot description to open ports, buses and boards."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from drivers.boards.calibration import FootConverter, ImuConverter
from drivers.boards.frames import FRAME_SIZE, KIND_FOOT, KIND_IMU
from drivers.boards.reader import BoardReader
from drivers.boards.sensors import BoardSensors, FootSensor, ImuSensor
from drivers.calibration import RobotCalibration
from drivers.dynamixel.audit import AuditResult, ExpectedServo, audit_bus
from drivers.dynamixel.budget import BusBudget, BusTiming, bus_budget, wire_time_ns
from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import VOLTAGE_UNIT, OperatingMode, Register
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.port import Port
from drivers.dynamixel.power import BusPower
from drivers.dynamixel.servo_models import servo_model_of
from drivers.dynamixel.states import ServoStates
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Clock
from hil.servo import JOINT_MODES


@dataclass(frozen=True, slots=True)
class BusParts:
    """One open bus before its hot path runs."""

    name: str
    port: Port
    timing: BusTiming
    servos: tuple[ExpectedServo, ...]
    joints: tuple[int, ...]
    """Joint indices, one a servo."""
    client: ServoClient
    group: GroupAccess
    power: BusPower

    def audit(self) -> AuditResult:
        """Check and correct the servos."""
        return audit_bus(self.name, self.client, self.group, self.servos)

    def read_slow(self, states: ServoStates) -> None:
        """Read all voltages and temperatures, so that the first tick knows them."""
        ids = [servo.id for servo in self.servos]
        voltages = self.group.read(Register.PRESENT_INPUT_VOLTAGE, ids)
        temperatures = self.group.read(Register.PRESENT_TEMPERATURE, ids)
        for servo_id, joint in zip(ids, self.joints, strict=True):
            states.voltage[joint] = VOLTAGE_UNIT * voltages.get(servo_id, np.nan)
            states.temperature[joint] = temperatures.get(servo_id, np.nan)


def bus_timing(description: RobotDescription, bus: str) -> BusTiming:
    """Speed and delays of a bus."""
    spec = description.buses[bus]
    return BusTiming(
        baud=spec.baud,
        latency_timer_ns=spec.latency_timer_ms * 1_000_000,
        usb_transfer_ns=description.timing.usb_transfer_us * 1000,
    )


def bus_budgets(
    description: RobotDescription, fast: Mapping[str, bool] | None = None
) -> list[BusBudget]:
    """Budget of every bus; `fast` says which use fast reads, all by default."""
    budgets = []
    for name in description.buses:
        count = sum(joint.bus == name for joint in description.joints)
        timing = bus_timing(description, name)
        compute_ns = description.timing.compute_us * 1000
        is_fast = True if fast is None else fast[name]
        budgets.append(bus_budget(name, timing, count, is_fast, compute_ns))
    return budgets


def require_bus_speeds(description: RobotDescription) -> None:
    """Raises InputError for a bus that is faster than one of its servos can be."""
    for joint in description.joints:
        model = servo_model_of(joint)
        bus = joint.bus or ""
        if description.buses[bus].baud not in model.bauds:
            raise InputError(
                f"{description.file}: buses.{bus}.baud {description.buses[bus].baud}: "
                f"{joint.name} is a {model.name}; its speeds: {', '.join(map(str, model.bauds))}"
            )


def port_url(port_urls: Mapping[str, str], name: str) -> str:
    """Where a bus or board is connected. Raises InputError."""
    if name not in port_urls:
        known = ", ".join(port_urls) or "none"
        raise InputError(f"no port is given for {name}; ports are given for: {known}")
    return port_urls[name]


def expected_servos(description: RobotDescription, bus: str) -> tuple[ExpectedServo, ...]:
    """Servos that the robot file has on a bus."""
    return tuple(
        ExpectedServo(
            joint.name,
            joint.id or 0,
            servo_model_of(joint),
            OperatingMode(JOINT_MODES[joint.mode]),
            description.safety.overload_ends_torque,
        )
        for joint in description.joints
        if joint.bus == bus
    )


def open_bus(description: RobotDescription, clock: Clock, name: str, url: str) -> BusParts:
    """Open a bus's port. Raises PortError."""
    timing = bus_timing(description, name)
    members = [
        (index, joint) for index, joint in enumerate(description.joints) if joint.bus == name
    ]
    servos = expected_servos(description, name)
    port = Port(name, url, timing.baud)
    group = GroupAccess(port, timing, clock)
    return BusParts(
        name=name,
        port=port,
        timing=timing,
        servos=servos,
        joints=tuple(index for index, _ in members),
        client=ServoClient(port, timing, clock),
        group=group,
        power=BusPower(name, group, [servo.id for servo in servos]),
    )


def assemble_boards(
    description: RobotDescription,
    calibration: RobotCalibration,
    ports: Mapping[str, Port],
    tick_ns: int,
) -> BoardSensors:
    """The boards of a robot on their open ports."""
    noise = description.noise

    def reader(board: str, kind: int) -> BoardReader:
        spec = description.boards[board]
        period_ns = 1_000_000_000 // spec.rate_hz
        wire_ns = wire_time_ns(FRAME_SIZE[kind], ports[board].baud)
        least_delay_ns = wire_ns + 1000 * (spec.delay_us + description.timing.usb_transfer_us)
        noisy = noise.corner_force > 0 if kind == KIND_FOOT else noise.gyro > 0
        return BoardReader(ports[board], least_delay_ns, period_ns, tick_ns, noisy)

    feet = {
        side: FootSensor(reader(foot.board, KIND_FOOT), FootConverter(calibration.feet[side]))
        for side, foot in description.feet.items()
        if foot.board is not None
    }
    imu = None
    if description.imu is not None:
        converter = ImuConverter(calibration.imu)
        imu = ImuSensor(reader(description.imu.board, KIND_IMU), converter)
    return BoardSensors(feet, imu)
