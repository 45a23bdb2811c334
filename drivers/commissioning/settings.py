"""How a servo of a robot is to be set up, what it is set to, and making the two agree."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from drivers.commissioning.line import ServoLine, value_in
from drivers.dynamixel.audit import FORBIDDEN_DRIVE_MODE, PWM_SLOPE, ExpectedServo
from drivers.dynamixel.control_table import (
    HardwareError,
    OperatingMode,
    Register,
    StatusReturnLevel,
)
from drivers.dynamixel.servo_models import ServoModel
from hil.bringup.facts import SettingChange
from hil.errors import BackendError
from hil.servo import COUNTS_PER_TURN, PWM_FULL

FIRST, LAST = Register.MODEL_NUMBER, Register.PRESENT_TEMPERATURE
"""Ends of the block that holds every register which matters."""
NO_SHADOW = 255


@dataclass(frozen=True, slots=True)
class Setting:
    """One register as it should be."""

    register: Register
    value: int
    why: str


class RegisterImage:
    """The registers of one servo at one moment."""

    def __init__(self, model: ServoModel | None, block: bytes) -> None:
        self._block = block
        self._model = model

    def __getitem__(self, register: Register) -> int:
        return value_in(self._block, FIRST, register)

    def named(self) -> dict[str, int]:
        """All registers that the model has, by name in the e-manual."""
        known = frozenset(Register) if self._model is None else self._model.registers
        return {
            register.spec.name: self[register]
            for register in Register
            if register in known and register.end <= LAST.end
        }


def read_image(line: ServoLine, servo_id: int, model: ServoModel | None) -> RegisterImage | None:
    """All registers of a servo; None if it does not tell."""
    block = line.read_block(servo_id, FIRST, LAST)
    return None if block is None else RegisterImage(model, block)


def wanted_settings(servo: ExpectedServo, image: RegisterImage) -> Iterator[Setting]:
    """How a servo should be set up, in an order in which it accepts it."""
    model = servo.model
    drive_mode = image[Register.DRIVE_MODE] & ~int(FORBIDDEN_DRIVE_MODE)
    rows = (
        Setting(Register.STATUS_RETURN_LEVEL, StatusReturnLevel.ALL, "every write is answered"),
        Setting(Register.OPERATING_MODE, int(servo.mode), "the robot file's mode"),
        Setting(Register.DRIVE_MODE, drive_mode, "not reversed, no torque by a mere goal"),
        Setting(Register.RETURN_DELAY_TIME, 0, "250 costs 0.5 ms a servo and tick"),
        Setting(Register.SHADOW_ID, NO_SHADOW, "obeys its own id only"),
        Setting(Register.HOMING_OFFSET, 0, "offsets live in the calibration file"),
        Setting(Register.MIN_POSITION_LIMIT, 0, _LIMITS),
        Setting(Register.MAX_POSITION_LIMIT, COUNTS_PER_TURN - 1, _LIMITS),
        Setting(Register.PWM_LIMIT, PWM_FULL, "the driver limits by Goal PWM"),
        *_factory(
            model,
            (Register.TEMPERATURE_LIMIT, "the model's own"),
            (Register.MIN_VOLTAGE_LIMIT, "the model's own"),
            (Register.MAX_VOLTAGE_LIMIT, "the model's own"),
            (Register.CURRENT_LIMIT, "the model's own"),
            (Register.VELOCITY_LIMIT, "the model's own"),
        ),
        Setting(Register.STARTUP_CONFIGURATION, 0, "power alone never means torque"),
        Setting(Register.PWM_SLOPE, PWM_SLOPE, "no lag of the duty"),
        Setting(Register.SHUTDOWN, int(servo.shutdown), "what ends the torque"),
    )
    firmware = image[Register.FIRMWARE_VERSION]
    for row in rows:
        if row.register in model.registers and not _too_old(row.register, model, firmware):
            yield row


_LIMITS = "the driver limits; a goal beyond would be ignored unsaid"


def _factory(model: ServoModel, *pairs: tuple[Register, str]) -> Iterator[Setting]:
    for register, why in pairs:
        value = model.initial(register)
        if value is not None:
            yield Setting(register, value, why)


def _too_old(register: Register, model: ServoModel, firmware: int) -> bool:
    newest = model.startup_firmware
    return register is Register.STARTUP_CONFIGURATION and (newest is None or firmware < newest)


def needed_changes(servo: ExpectedServo, image: RegisterImage) -> tuple[SettingChange, ...]:
    """Settings that are not as they should be."""
    return tuple(
        SettingChange(setting.register.spec.name, image[setting.register], setting.value,
                      setting.why)
        for setting in wanted_settings(servo, image)
        if image[setting.register] != setting.value
    )  # fmt: skip


def why_untouchable(servo: ExpectedServo, image: RegisterImage) -> str:
    """Why a servo must not be set up now; empty if it may."""
    if image[Register.MODEL_NUMBER] != servo.model.number:
        return f"is model number {image[Register.MODEL_NUMBER]}, not {servo.model.name}"
    if image[Register.TORQUE_ENABLE]:
        return "torque is on: stride relax first"
    return ""


def apply_changes(
    line: ServoLine, servo: ExpectedServo, servo_id: int, changes: Sequence[SettingChange]
) -> None:
    """Write settings and read them back. Raises BackendError naming what was not kept."""
    client, registers = line.client, {register.spec.name: register for register in Register}
    # A servo that does not answer writes could not be told anything else.
    line.tell(servo_id, Register.STATUS_RETURN_LEVEL, int(StatusReturnLevel.ALL))
    for change in changes:
        client.write(servo_id, registers[change.register], change.wanted)
    image = read_image(line, servo_id, servo.model)
    left = None if image is None else needed_changes(servo, image)
    if left is None or left:
        what = "does not answer any more" if left is None else (
            "kept " + ", ".join(f"{row.register} {row.found}" for row in left)
        )  # fmt: skip
        raise BackendError(f"{line.port.name} id {servo_id} ({servo.joint}): {what}")


def errors_by_name(value: int) -> str:
    """Hardware Error Status in words."""
    error = HardwareError(value)
    return ", ".join((one.name or str(one.value)).lower().replace("_", " ") for one in error)


def mode_name(value: int) -> str:
    """Operating Mode in words."""
    if value in set(OperatingMode):
        return OperatingMode(value).name.lower().replace("_", " ")
    return f"unknown mode {value}"
