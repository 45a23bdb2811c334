"""Torque on and torque off, both read back."""

from collections.abc import Mapping, Sequence

from drivers.dynamixel.control_table import HardwareError, Register
from drivers.dynamixel.group_access import GroupAccess
from hil.errors import BackendError
from hil.servo import PWM_FULL

WATCHDOG_UNITS = 2
"""Bus Watchdog while armed: 40 ms without any packet and the servo holds where it is."""
TORQUE_OFF_ATTEMPTS = 5
_ZEROED = (
    Register.POSITION_D_GAIN,
    Register.POSITION_I_GAIN,
    Register.FEEDFORWARD_1ST_GAIN,
    Register.FEEDFORWARD_2ND_GAIN,
)
"""Gains that leave the factory at other values, or were left over; the driver works without."""


class BusPower:
    """Switches the servos of one bus on and off."""

    def __init__(self, bus: str, group: GroupAccess, ids: Sequence[int]) -> None:
        self._bus = bus
        self._group = group
        self._ids = list(ids)

    def present_positions(self) -> dict[int, int]:
        """Where every servo is [counts]. Raises BackendError for one that does not answer."""
        positions = self._group.read(Register.PRESENT_POSITION, self._ids)
        self._require_all(positions, "its position")
        return positions

    def prepare(
        self,
        positions: Mapping[int, int],
        p_gains: Mapping[int, int],
        currents: Mapping[int, int] | None = None,
    ) -> None:
        """Put goals at the present positions and gains in place. Raises BackendError.

        `currents`: goals of servos in current mode and limits of those in current-based position
        mode; a change of mode leaves them at the largest there is.
        """
        expected: dict[Register, dict[int, int]] = {
            register: dict.fromkeys(self._ids, 0) for register in _ZEROED
        }
        expected[Register.POSITION_P_GAIN] = dict(p_gains)
        expected[Register.GOAL_PWM] = dict.fromkeys(self._ids, PWM_FULL)
        expected[Register.GOAL_POSITION] = dict(positions)
        if currents is not None:
            expected[Register.GOAL_CURRENT] = dict(currents)
        for register, values in expected.items():
            self._write_verified(register, values)

    def on(self) -> None:
        """Switch torque on, read back. Raises BackendError."""
        self._write_verified(Register.TORQUE_ENABLE, dict.fromkeys(self._ids, 1))

    def arm_watchdog(self) -> None:
        """From now on a bus without packets stops its servos. Raises BackendError."""
        self._write_verified(Register.BUS_WATCHDOG, dict.fromkeys(self._ids, WATCHDOG_UNITS))

    def send_off(self) -> None:
        """Send torque-off frames without waiting for anybody."""
        self._group.write_all(Register.TORQUE_ENABLE, self._ids, 0)
        self._group.write_all(Register.BUS_WATCHDOG, self._ids, 0)

    def off(self) -> bool:
        """Switch torque off until every servo says so; False if one does not."""
        for _ in range(TORQUE_OFF_ATTEMPTS):
            self.send_off()
            values = self._group.read(Register.TORQUE_ENABLE, self._ids)
            if len(values) == len(self._ids) and not any(values.values()):
                return True
        return False

    def hold(self, goals: Mapping[int, int], currents: Mapping[int, int] | None = None) -> bool:
        """Leave torque on at the last goals, without the watchdog; whether it was read back.

        `currents` as in `prepare`: a servo in current mode has no place to hold, and gets none.
        """
        self._group.write_all(Register.BUS_WATCHDOG, self._ids, 0)
        if currents is not None:
            self._group.write(Register.GOAL_CURRENT, currents)
        self._group.write(Register.GOAL_POSITION, goals)
        return self._group.read(Register.GOAL_POSITION, self._ids) == dict(goals)

    def _write_verified(self, register: Register, expected: Mapping[int, int]) -> None:
        """Write and read back, twice if it must be."""
        values: dict[int, int] = {}
        for _ in range(2):
            self._group.write(register, expected)
            values = self._group.read(register, self._ids)
            if values == expected:
                return
        self._require_all(values, register.spec.name)
        wrong = [servo_id for servo_id in self._ids if values[servo_id] != expected[servo_id]]
        if wrong:
            errors = self._group.read(Register.HARDWARE_ERROR_STATUS, wrong)
            found = "; ".join(
                f"id {servo_id} has {values[servo_id]} instead of {expected[servo_id]}"
                f"{_error_text(errors.get(servo_id, 0))}"
                for servo_id in wrong
            )
            raise BackendError(f"bus {self._bus}: {register.spec.name} was not accepted: {found}")

    def _require_all(self, values: Mapping[int, int], what: str) -> None:
        missing = [str(servo_id) for servo_id in self._ids if servo_id not in values]
        if missing:
            raise BackendError(f"bus {self._bus}: id {', '.join(missing)} does not tell {what}")


def _error_text(error: int) -> str:
    return f" (hardware error: {HardwareError(error)!r})" if error else ""
