"""One servo that is moved by hand, so to say: gently, in sight, and limp again afterwards."""

import math

from drivers.commissioning.line import ServoLine, value_in
from drivers.commissioning.search import BAUDS, models_by_number
from drivers.commissioning.settings import RegisterImage, errors_by_name, mode_name, read_image
from drivers.dynamixel.control_table import (
    POSITION_UNIT,
    VELOCITY_UNIT,
    VOLTAGE_UNIT,
    WATCHDOG_TRIPPED,
    WATCHDOG_UNIT_NS,
    DriveMode,
    OperatingMode,
    Register,
)
from drivers.dynamixel.servo_models import ServoModel
from drivers.guardian import Guardian
from hil.bringup.facts import JogSample
from hil.errors import BackendError, InputError
from hil.servo import PWM_FULL

WATCHDOG_UNITS = 15
"""Silence of 300 ms stops the servo: nobody walks on it, and any computer speaks up by then."""
DEGREES = math.degrees(POSITION_UNIT)
"""Of one count."""
LOST_SAMPLES = 8
"""Looks in a row without an answer that end a movement."""
_POSITION_MODES = (
    OperatingMode.POSITION,
    OperatingMode.EXTENDED_POSITION,
    OperatingMode.CURRENT_BASED_POSITION,
)
_TEMPERATURE_HEADROOM = 10
_BEGIN, _END = Register.TORQUE_ENABLE, Register.PRESENT_TEMPERATURE
_KEPT = (Register.GOAL_PWM, Register.PROFILE_ACCELERATION, Register.PROFILE_VELOCITY)


def find_servo(line: ServoLine, servo_id: int, baud: int | None) -> int:
    """The speed at which a servo answers; the line keeps it. Raises BackendError."""
    for one in BAUDS if baud is None else (baud,):
        line.port.set_baud(one)
        if line.ping(servo_id).packets:
            return one
    at = "any speed" if baud is None else f"{baud} baud"
    raise BackendError(
        f"{line.port.url}: no servo with id {servo_id} answers at {at}; who does: "
        f"stride scan {line.port.url}"
    )


class OneServo:
    """A servo at rest that may be moved between `begin` and `end`.

    Its duty is limited by Goal PWM (and its current by Goal Current where its mode regulates
    current), its speed by the profile. A guardian process switches torque off if this one is
    killed.
    """

    def __init__(self, line: ServoLine, servo_id: int) -> None:
        """Raises BackendError for a servo that does not answer or is not known."""
        self.line = line
        self.id = servo_id
        number = line.client.read(servo_id, Register.MODEL_NUMBER)
        model = models_by_number().get(number)
        if model is None:
            raise BackendError(f"{self.where}: model number {number} is not known")
        self.model: ServoModel = model
        image = read_image(line, servo_id, model)
        if image is None:
            raise BackendError(f"{self.where}: does not tell its registers")
        self._image: RegisterImage = image
        self._power = line.power([servo_id])
        self._guardian = Guardian(self._off_repeatedly)
        self._goal = self.start = image[Register.PRESENT_POSITION]
        """Where it stood at first [counts]."""
        self._lost = 0

    @property
    def where(self) -> str:
        """For a person."""
        return f"{self.line.port.url} id {self.id}"

    @property
    def firmware(self) -> int:
        """Firmware version."""
        return self._image[Register.FIRMWARE_VERSION]

    @property
    def mode(self) -> str:
        """Operating mode in words."""
        return mode_name(self._image[Register.OPERATING_MODE])

    def require_movable(self, reach_deg: float) -> None:
        """Raises InputError for a servo that cannot be moved so far either way, now."""
        image, model = self._image, self.model
        volts = VOLTAGE_UNIT * image[Register.PRESENT_INPUT_VOLTAGE]
        low, high = model.input_voltage
        limit = model.temperature_limit - _TEMPERATURE_HEADROOM
        reasons = {
            "torque is on already: stride relax first": bool(image[Register.TORQUE_ENABLE]),
            "hardware error: " + errors_by_name(image[Register.HARDWARE_ERROR_STATUS]): bool(
                image[Register.HARDWARE_ERROR_STATUS]
            ),
            f"{volts:.1f} V, {model.name} takes {low} to {high} V": not low <= volts <= high,
            f"{image[Register.PRESENT_TEMPERATURE]} °C is too warm, the limit is {limit} °C": (
                image[Register.PRESENT_TEMPERATURE] > limit
            ),
            f"is in {self.mode} mode; it needs one of positions, such as 3": (
                image[Register.OPERATING_MODE] not in _POSITION_MODES
            ),
            "its profile is time-based (Drive Mode bit 2): set that to 0 first": bool(
                image[Register.DRIVE_MODE] & DriveMode.TIME_BASED_PROFILE
            ),
        }
        wrong = [reason for reason, applies in reasons.items() if applies]
        wrong += self._why_no_room(reach_deg)
        if wrong:
            raise InputError(f"{self.where} cannot be moved: {'; '.join(wrong)}")

    def _why_no_room(self, reach_deg: float) -> list[str]:
        image = self._image
        if image[Register.OPERATING_MODE] != OperatingMode.POSITION:
            return []
        reach = round(reach_deg / DEGREES)
        low, high = image[Register.MIN_POSITION_LIMIT], image[Register.MAX_POSITION_LIMIT]
        if low <= self.start - reach and self.start + reach <= high:
            return []
        return [
            f"stands at count {self.start}, its limits are {low} to {high}: turn it by hand to "
            f"{low + reach} to {high - reach}"
        ]

    def begin(self, effort: float, speed_dps: float, watchdog_units: int = WATCHDOG_UNITS) -> None:
        """Torque on where it stands, at a share of full duty. Raises BackendError."""
        client, pwm = self.line.client, round(effort * PWM_FULL)
        client.write(self.id, Register.BUS_WATCHDOG, 0)
        client.write(self.id, Register.GOAL_PWM, pwm)
        if self._image[Register.OPERATING_MODE] == OperatingMode.CURRENT_BASED_POSITION:
            most = self._image[Register.CURRENT_LIMIT]
            client.write(self.id, Register.GOAL_CURRENT, round(effort * most))
        self.profile(speed_dps)
        self.go(0.0)
        self._guardian.start()
        self._power.on()
        client.write(self.id, Register.BUS_WATCHDOG, watchdog_units)

    def profile(self, speed_dps: float) -> None:
        """Speed and, reached in a tenth of a second, acceleration of the profile; 0 for none."""
        velocity = round(math.radians(speed_dps) / VELOCITY_UNIT)
        # [214.577 rev/min²] of one count (e-manual): velocity in 0.1 s.
        acceleration = math.ceil(velocity * 0.229 * 600 / 214.577) if velocity else 0
        client = self.line.client
        client.write(self.id, Register.PROFILE_ACCELERATION, acceleration)
        client.write(self.id, Register.PROFILE_VELOCITY, max(velocity, 1) if speed_dps else 0)

    def go(self, angle_deg: float) -> None:
        """A goal, from where it stood at first. Raises BackendError."""
        self._goal = self.start + round(angle_deg / DEGREES)
        try:
            self.line.client.write(self.id, Register.GOAL_POSITION, self._goal)
        except BackendError as error:
            if self.line.client.read(self.id, Register.BUS_WATCHDOG) == WATCHDOG_TRIPPED:
                raise BackendError(
                    f"{self.where}: its bus watchdog tripped: this computer said nothing for "
                    f"{WATCHDOG_UNITS * WATCHDOG_UNIT_NS // 1_000_000} ms; is it busy?"
                ) from error
            raise

    def look(self, time_s: float) -> JogSample | None:
        """Where it is; None for a lost answer. Raises BackendError when it is not itself."""
        block, _ = self.line.hear_block(self.id, _BEGIN, _END)
        if block is None:
            self._lost += 1
            if self._lost >= LOST_SAMPLES:
                raise BackendError(f"{self.where}: stopped answering")
            return None
        self._lost = 0
        errors = value_in(block, _BEGIN, Register.HARDWARE_ERROR_STATUS)
        if errors:
            raise BackendError(f"{self.where}: hardware error: {errors_by_name(errors)}")
        if not value_in(block, _BEGIN, Register.TORQUE_ENABLE):
            raise BackendError(f"{self.where}: its torque went off by itself")
        return self._sample(block, time_s)

    def _sample(self, block: bytes, time_s: float) -> JogSample:
        def value(register: Register) -> int:
            return value_in(block, _BEGIN, register)

        unit = self.model.current_unit
        return JogSample(
            time_s=time_s,
            goal_deg=DEGREES * (self._goal - self.start),
            position_deg=DEGREES * (value(Register.PRESENT_POSITION) - self.start),
            planned_deg=DEGREES * (value(Register.POSITION_TRAJECTORY) - self.start),
            velocity_dps=math.degrees(VELOCITY_UNIT) * value(Register.PRESENT_VELOCITY),
            duty_pct=100.0 * value(Register.PRESENT_PWM) / PWM_FULL,
            current_a=None if unit is None else unit * value(Register.PRESENT_CURRENT),
            voltage_v=round(VOLTAGE_UNIT * value(Register.PRESENT_INPUT_VOLTAGE), 1),
            temperature_c=value(Register.PRESENT_TEMPERATURE),
        )

    def end(self) -> None:
        """Torque off until it is read back, RAM as it was. Raises BackendError if it is not."""
        try:
            if not self._power.off():
                raise BackendError(
                    f"{self.where}: torque off was sent and never read back: cut the servo power"
                )
            for register in _KEPT:
                self.line.client.write(self.id, register, self._image[register])
        finally:
            self._guardian.close()

    def _off_repeatedly(self) -> None:
        for _ in range(5):
            self._power.send_off()
