"""The motor side of an emulated servo: what its registers make the motor do, and what it measures.

Registers show values in the servo's drive mode; the motor knows only its own direction.
"""

import struct
from collections.abc import Callable

from drivers.dynamixel.control_table import (
    REALTIME_TICK_MODULUS,
    DriveMode,
    HardwareError,
    OperatingMode,
    Register,
)
from hil.servo import CENTRE_COUNTS
from sim_backends.virtual.motors import PRESENT, Motor, Reading
from sim_backends.virtual.register_file import RegisterFile

_SINGLE_TURN_OFFSET = 1024
"""Largest Homing Offset that counts in the position mode; a larger one is ignored."""
_TORQUE = Register.TORQUE_ENABLE.address
_ERROR = Register.HARDWARE_ERROR_STATUS.address
_GOAL_ADDRESS = Register.GOAL_POSITION.address
_GOAL_POSITION = struct.Struct("<i")
_PRESENT = Register.REALTIME_TICK.address


class ServoDrive:
    """Carries settings, gains and goals to the motor, and its measurements into the registers.

    Present Position = s·(c − 2048) + 2048 + offset for encoder counts c and direction s = ±1.
    Hardware errors are latched; one in the Shutdown mask opens the bridge until a reboot. Torque
    Enable adopts no goal by itself (assumed): a goal that is far away makes the joint jump.
    """

    def __init__(self, registers: RegisterFile, motor: Motor, now_ns: Callable[[], int]) -> None:
        self._registers = registers
        self._memory = registers.memory
        self._motor = motor
        self._now_ns = now_ns
        self._mode: int | None = None
        self.sense: Callable[[], Reading] = motor.reading
        """What it measures; a fault may stand in between."""
        self.frozen = False
        """A fault: its measured registers stand still."""
        self.on_torque: Callable[[bool], None] = lambda _: None
        """Told the torque whenever it is switched, or told again to stay."""
        self._encoder_error = 0
        self._aim = CENTRE_COUNTS

    def power_on(self) -> None:
        """State after power-on or reboot: torque off, goal where the joint is."""
        self._latched = False
        self._booted_ns = self._now_ns()
        self._motor.reboot()
        self._mode = None
        self.adopt_settings()
        self._registers[Register.GOAL_POSITION] = self._shown(self.sense())
        self.switch_torque()
        self.adopt_gains()
        self.adopt_goals()
        self.adopt_goal()

    # Registers to the motor ------------------------------------------------------------------

    def adopt_settings(self) -> None:
        """Take over the EEPROM area."""
        registers, motor = self._registers, self._motor
        registers.adopt_mode()
        mode, drive_mode = registers[Register.OPERATING_MODE], registers[Register.DRIVE_MODE]
        offset = registers[Register.HOMING_OFFSET]
        ignored = mode == OperatingMode.POSITION and abs(offset) > _SINGLE_TURN_OFFSET
        self._offset = CENTRE_COUNTS + (0 if ignored else offset)
        self._sign = -1 if drive_mode & DriveMode.REVERSE else 1
        self._time_based = bool(drive_mode & DriveMode.TIME_BASED_PROFILE)
        self._torque_on_by_goal = drive_mode & DriveMode.TORQUE_ON_BY_GOAL_UPDATE
        self._threshold = registers[Register.MOVING_THRESHOLD]
        self._hottest = registers[Register.TEMPERATURE_LIMIT]
        self._lowest = registers[Register.MIN_VOLTAGE_LIMIT]
        self._highest = registers[Register.MAX_VOLTAGE_LIMIT]
        self._shutdown = registers[Register.SHUTDOWN]
        if mode != self._mode:
            self._mode = mode
            motor.set_mode(mode)
        model = registers.model
        current = None if model.current_limit is None else registers[Register.CURRENT_LIMIT]
        motor.set_limits(registers[Register.PWM_LIMIT], current)
        motor.set_pwm_slope(None if model.pwm_slope is None else registers[Register.PWM_SLOPE])
        motor.set_protection(self._hottest, self._lowest, self._highest, self._shutdown)

    def change_mode(self) -> None:
        """Operating Mode was written: gains, profile and goals go back to its defaults."""
        if self._registers[Register.OPERATING_MODE] == self._mode:
            return
        self._registers.reset_control()
        self.adopt_settings()
        self.adopt_gains()
        self.adopt_goals()

    def change_limits(self) -> None:
        """PWM Limit was written: goals follow it."""
        self._registers.reset_goals()
        self.adopt_settings()
        self.adopt_goals()

    def switch_torque(self) -> None:
        """Torque Enable was written, or an error wants it off."""
        if self._latched:
            self._memory[_TORQUE] = 0
        on = bool(self._memory[_TORQUE])
        self._motor.enable(on)
        self.on_torque(on)

    def lose_torque(self) -> None:
        """Torque goes off by itself, without an error."""
        self._memory[_TORQUE] = 0
        self.switch_torque()

    def adopt_gains(self) -> None:
        """Take over gains and profile."""
        registers, motor = self._registers, self._motor
        motor.set_gains(
            registers[Register.POSITION_P_GAIN],
            registers[Register.POSITION_I_GAIN],
            registers[Register.POSITION_D_GAIN],
            registers[Register.FEEDFORWARD_1ST_GAIN],
            registers[Register.FEEDFORWARD_2ND_GAIN],
        )
        motor.set_velocity_gains(
            registers[Register.VELOCITY_P_GAIN], registers[Register.VELOCITY_I_GAIN]
        )
        motor.set_profile(
            registers[Register.PROFILE_VELOCITY],
            registers[Register.PROFILE_ACCELERATION],
            self._time_based,
        )

    def adopt_goals(self) -> None:
        """Take over Goal PWM, Goal Current and Goal Velocity."""
        registers, motor, sign = self._registers, self._motor, self._sign
        motor.set_goal_pwm(sign * registers[Register.GOAL_PWM])
        motor.set_goal_current(sign * registers[Register.GOAL_CURRENT])
        motor.set_goal_velocity(sign * registers[Register.GOAL_VELOCITY])

    def new_goal(self) -> None:
        """Goal Position was written."""
        self.adopt_goal()
        if self._torque_on_by_goal and not self._memory[_TORQUE]:
            self._memory[_TORQUE] = 1
            self.switch_torque()

    def adopt_goal(self) -> None:
        """Take over Goal Position."""
        (self._goal,) = _GOAL_POSITION.unpack_from(self._memory, _GOAL_ADDRESS)
        self._aim = self._sign * (self._goal - self._offset) + CENTRE_COUNTS
        self._motor.set_goal(self._aim - self._encoder_error)

    def hold(self) -> None:
        """Stop where it is: the bus watchdog tripped. Profiles count as 0 (e-manual)."""
        self._motor.set_profile(0, 0, self._time_based)
        self._motor.set_goal_velocity(0)
        self._aim = self.sense().position
        self._motor.set_goal(self._aim - self._encoder_error)

    def shift_encoder(self, error: int) -> None:
        """A fault: the encoder shows so much too much [counts], and the loop follows it."""
        self._encoder_error = error
        self._motor.set_goal(self._aim - error)

    # The motor to registers ------------------------------------------------------------------

    def _shown(self, reading: Reading) -> int:
        return self._sign * (reading.position - CENTRE_COUNTS) + self._offset

    def measure(self) -> None:
        """Bring the measured registers, and the hardware error, to the last grid point."""
        if self.frozen:
            return
        pwm, current, velocity, position, voltage, temperature = self.sense()
        sign = self._sign
        velocity *= sign
        tick = (self._now_ns() - self._booted_ns) // 1_000_000 % REALTIME_TICK_MODULUS
        moving = abs(velocity) > self._threshold
        error = self._motor.hardware_error()
        if temperature > self._hottest:
            error |= HardwareError.OVERHEATING
        if not self._lowest <= voltage <= self._highest:
            error |= HardwareError.INPUT_VOLTAGE
        if error & ~self._memory[_ERROR]:
            self.raise_error(error)
        PRESENT.pack_into(
            self._memory, _PRESENT, tick, moving, 0, sign * pwm, sign * current, velocity,
            sign * (position - CENTRE_COUNTS) + self._offset, 0, self._goal, voltage, temperature,
        )  # fmt: skip

    def measure_trajectory(self) -> None:
        """Bring Velocity Trajectory and Position Trajectory to the last grid point."""
        velocity, position = self._motor.trajectory()
        registers, sign = self._registers, self._sign
        registers[Register.VELOCITY_TRAJECTORY] = sign * velocity
        registers[Register.POSITION_TRAJECTORY] = sign * (position - CENTRE_COUNTS) + self._offset

    def raise_error(self, error: int) -> None:
        """Latch hardware errors; one that the Shutdown mask holds ends the torque."""
        self._memory[_ERROR] |= error
        if self._shutdown & error:
            self._latched = True
            self.lose_torque()
