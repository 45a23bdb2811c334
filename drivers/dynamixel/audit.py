"""Are these the servos that the robot file speaks of, and are they set up as the driver needs?

EEPROM settings that are wrong are corrected where torque is off; torque itself is left as found.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import (
    DriveMode,
    HardwareError,
    OperatingMode,
    Register,
    StatusReturnLevel,
)
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.servo_models import SERVO_MODELS, ServoModel
from hil.errors import BackendError
from hil.servo import COUNTS_PER_TURN

FORBIDDEN_DRIVE_MODE = DriveMode.REVERSE | DriveMode.TORQUE_ON_BY_GOAL_UPDATE
"""Directions are the robot file's, and a goal must not switch torque on."""
SHUTDOWN = HardwareError.OVERHEATING | HardwareError.ELECTRICAL_SHOCK | HardwareError.OVERLOAD
"""Errors that end the torque in the servo itself. Not the input voltage: the sag of one hard step
would leave a joint limp until it is restarted; the supervisor watches the voltage."""
PWM_SLOPE = 255
"""The fastest; the factory's 140 of a 5 V servo takes 18 ms from no duty to all of it."""


@dataclass(frozen=True, slots=True)
class ExpectedServo:
    """What the robot file says of one servo."""

    joint: str
    id: int
    model: ServoModel
    mode: OperatingMode = OperatingMode.POSITION
    overload_ends_torque: bool = True
    """Whether the servo may switch itself off for what its firmware calls an overload."""

    @property
    def shutdown(self) -> HardwareError:
        """Errors that end the torque: the Shutdown mask."""
        return SHUTDOWN if self.overload_ends_torque else SHUTDOWN & ~HardwareError.OVERLOAD


@dataclass(slots=True)
class AuditResult:
    """What was found on one bus."""

    problems: list[str] = field(default_factory=list)
    """Servos that are missing or wrong; with any of them the robot cannot be used."""
    changes: list[str] = field(default_factory=list)
    """Settings that were corrected."""
    fast_reads: bool = True
    """Every servo's firmware knows fast reads."""


def audit_bus(
    bus: str, client: ServoClient, group: GroupAccess, servos: Sequence[ExpectedServo]
) -> AuditResult:
    """Ping every servo, check its model and correct its settings. Raises BackendError."""
    result = AuditResult()
    ids = [servo.id for servo in servos]
    # Without this a servo may not answer reads; it is RAM, and nobody acknowledges a sync write.
    group.write_all(Register.STATUS_RETURN_LEVEL, ids, StatusReturnLevel.ALL)
    present = [servo for servo in servos if _identify(bus, client, servo, result)]
    if result.problems:
        return result
    for register in (
        Register.BUS_WATCHDOG,
        Register.PROFILE_ACCELERATION,
        Register.PROFILE_VELOCITY,
    ):
        group.write_all(register, ids, 0)
    _correct(bus, client, group, present, result)
    _check_position_limits(bus, group, present, result)
    _check_firmware(bus, group.read(Register.FIRMWARE_VERSION, ids), servos, result)
    return result


def _identify(bus: str, client: ServoClient, servo: ExpectedServo, result: AuditResult) -> bool:
    number = client.ping(servo.id)
    if number == servo.model.number:
        return True
    if number is None:
        result.problems.append(f"bus {bus} id {servo.id} ({servo.joint}) does not answer")
        return False
    names = {model.number: model.name for model in SERVO_MODELS.values()}
    found = names.get(number, f"model number {number}")
    result.problems.append(
        f"bus {bus} id {servo.id} ({servo.joint}) is {found}, the robot file says "
        f"{servo.model.name}"
    )
    return False


def _check_firmware(
    bus: str, firmware: dict[int, int], servos: Sequence[ExpectedServo], result: AuditResult
) -> None:
    """What a servo can do depends on its firmware; a bus does what all of its servos can."""
    for servo in servos:
        version, least = firmware.get(servo.id, 0), servo.model.watchdog_firmware
        result.fast_reads &= servo.model.supports_fast_read(version)
        if version < least:
            result.problems.append(
                f"bus {bus} id {servo.id} ({servo.joint}) has firmware {version}, without the bus "
                f"watchdog that stops it when the host dies; update it to {least} or later"
            )


def _wanted(register: Register, value: int, servo: ExpectedServo) -> int:
    """What a setting should be, given what it is."""
    if register is Register.PWM_SLOPE:
        return PWM_SLOPE
    if register is Register.SHUTDOWN:
        return int(servo.shutdown)
    if register is Register.DRIVE_MODE:
        return value & ~int(FORBIDDEN_DRIVE_MODE)
    return int(servo.mode) if register is Register.OPERATING_MODE else 0


def _correct(
    bus: str,
    client: ServoClient,
    group: GroupAccess,
    servos: Sequence[ExpectedServo],
    result: AuditResult,
) -> None:
    ids = [servo.id for servo in servos]
    torque = group.read(Register.TORQUE_ENABLE, ids)
    for register in (
        Register.RETURN_DELAY_TIME,
        Register.DRIVE_MODE,
        Register.OPERATING_MODE,
        Register.PWM_SLOPE,
        Register.SHUTDOWN,
    ):
        concerned = [servo for servo in servos if register in servo.model.registers]
        values = group.read(register, [servo.id for servo in concerned])
        for servo in concerned:
            where = f"bus {bus} id {servo.id} ({servo.joint})"
            if servo.id not in values or servo.id not in torque:
                result.problems.append(f"{where} stopped answering")
                return
            value = values[servo.id]
            wanted = _wanted(register, value, servo)
            if value == wanted:
                continue
            if torque[servo.id]:
                raise BackendError(
                    f"{where}: {register.spec.name} is {value}, must be {wanted}, and torque is "
                    "on: switch torque off first"
                )
            client.write(servo.id, register, wanted)
            result.changes.append(f"{where}: {register.spec.name} {value} -> {wanted}")


def _check_position_limits(
    bus: str, group: GroupAccess, servos: Sequence[ExpectedServo], result: AuditResult
) -> None:
    """A servo ignores goals beyond its own limits, and a sync write does not say so."""
    ids = [servo.id for servo in servos]
    lowest = group.read(Register.MIN_POSITION_LIMIT, ids)
    highest = group.read(Register.MAX_POSITION_LIMIT, ids)
    for servo in servos:
        limits = lowest.get(servo.id), highest.get(servo.id)
        if limits != (0, COUNTS_PER_TURN - 1):
            result.problems.append(
                f"bus {bus} id {servo.id} ({servo.joint}) has position limits {limits[0]} to "
                f"{limits[1]} and would ignore goals beyond; set Min and Max Position Limit to 0 "
                f"and {COUNTS_PER_TURN - 1}"
            )
