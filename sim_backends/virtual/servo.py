"""One emulated Dynamixel: what its firmware does with instructions, and with its motor."""

import struct
from collections.abc import Callable

from drivers.dynamixel.control_table import (
    EEPROM_END,
    REALTIME_TICK_MODULUS,
    WATCHDOG_TRIPPED,
    WATCHDOG_UNIT_NS,
    DriveMode,
    HardwareError,
    OperatingMode,
    Register,
)
from drivers.dynamixel.protocol import ALERT, StatusError
from hil.servo import CENTRE_COUNTS
from sim_backends.virtual.motors import PRESENT, Motor, Reading
from sim_backends.virtual.register_file import RegisterFile
from sim_backends.virtual.register_rules import Rows, check_value, write_plan

BOOT_NS = 200_000_000
"""From REBOOT to the first answer [ns]; assumed."""
_POSITION_MODES = (OperatingMode.POSITION, OperatingMode.EXTENDED_POSITION)
_SINGLE_TURN_OFFSET = 1024
"""Largest Homing Offset that counts in the position mode; a larger one is ignored."""
_CLEAR_POSITION = b"\x01\x44\x58\x4c\x22"
_TORQUE = Register.TORQUE_ENABLE.address
_ERROR = Register.HARDWARE_ERROR_STATUS.address
_WATCHDOG = Register.BUS_WATCHDOG.address
_GOAL_ADDRESS = Register.GOAL_POSITION.address
_GOAL_POSITION = struct.Struct("<i")
_PRESENT, _PRESENT_END = Register.REALTIME_TICK.address, Register.PRESENT_TEMPERATURE.end
_GOALS, _GOALS_END = Register.GOAL_PWM.address, Register.GOAL_POSITION.end


class EmulatedServo:
    """Registers with the firmware's rules, on a motor of the plant.

    Modelled: access rules, EEPROM lock, resets by the operating mode, registered writes, alert
    bit and latched hardware errors (input voltage, overheating), bus watchdog, realtime tick,
    indirect cells, homing offset, reverse and torque-on-by-goal drive modes. The position modes
    drive the motor by P and D gain and Goal PWM; in the other modes it gets no voltage, and motion
    profiles, I and feed-forward gains have no effect. Measured registers hold the last physics
    grid point and, like hardware errors, are looked at when they are read. Torque Enable adopts
    no goal by itself (assumed): a goal that is far away makes the joint jump.
    """

    def __init__(self, registers: RegisterFile, motor: Motor, now_ns: Callable[[], int]) -> None:
        self.registers = registers
        self._memory = registers.memory
        self._motor = motor
        self._now_ns = now_ns
        self._effects: dict[int, Callable[[], None]] = self._make_effects()
        self.on_watchdog: Callable[[], None] = lambda: None
        """Called when `watchdog_ns` may have changed."""
        self.ready_ns = 0
        """From when on it answers [ns]."""
        self._power_on()

    def _make_effects(self) -> dict[int, Callable[[], None]]:
        effects = {
            register.address: self._adopt_settings
            for register in Register
            if register.address < EEPROM_END
        }
        special = {
            Register.OPERATING_MODE: self._change_mode,
            Register.PWM_LIMIT: self._change_limits,
            Register.STATUS_RETURN_LEVEL: self._adopt_settings,
            Register.TORQUE_ENABLE: self._switch_torque,
            Register.BUS_WATCHDOG: self._arm_watchdog,
            Register.POSITION_P_GAIN: self._adopt_gains,
            Register.POSITION_D_GAIN: self._adopt_gains,
            Register.GOAL_PWM: self._adopt_gains,
            Register.GOAL_POSITION: self._new_goal,
        }
        return effects | {register.address: effect for register, effect in special.items()}

    def _power_on(self) -> None:
        """State after power-on or reboot: torque off, goal where the joint is."""
        self._registered: tuple[int, bytes] | None = None
        self._latched = False
        self._booted_ns = self._now_ns()
        self._adopt_settings()
        self.registers[Register.GOAL_POSITION] = self._shown(self._motor.reading())
        self._switch_torque()
        self._arm_watchdog()
        self._adopt_gains()
        self._adopt_goal()

    # Instructions ----------------------------------------------------------------------------

    def identity(self) -> bytes:
        """Answer to a ping: model number and firmware."""
        return bytes(self._memory[0:2]) + bytes(self._memory[6:7])

    def error(self, status: StatusError = StatusError.NONE) -> int:
        """Error byte of an answer, with the alert bit."""
        return status | ALERT if self._memory[_ERROR] else int(status)

    def read(self, address: int, length: int) -> tuple[int, bytes]:
        """Error byte and data of a read."""
        end = address + length
        if _PRESENT <= address < end <= _PRESENT_END:  # What a driver reads in every tick.
            self._measure()
            return ALERT if self._memory[_ERROR] else 0, bytes(self._memory[address:end])
        if self.registers.reaches_present(address, length):
            self._measure()
        found = self.registers.read(address, length)
        if found is None:
            return self.error(StatusError.ACCESS), b""
        return self.error(), found

    def write(self, address: int, data: bytes) -> int:
        """Write bytes; the error byte of the answer. A register in error keeps all of them out."""
        if address == _GOAL_ADDRESS and len(data) == _GOAL_POSITION.size and self._take_goal(data):
            return self.error()
        runs = self.registers.split_indirect(address, data)
        if runs is None:
            return self.error(self._write_run(address, data))
        problems = [self._write_run(*run) for run in runs]
        return self.error(next(filter(None, problems), StatusError.NONE))

    def register_write(self, address: int, data: bytes) -> int:
        """Keep a write for ACTION; the error byte of the answer."""
        self._registered = (address, data)
        self.registers[Register.REGISTERED_INSTRUCTION] = 1
        return self.error()

    def act(self) -> int:
        """Execute what was registered; the error byte of the answer."""
        if self._registered is None:
            return self.error(StatusError.RESULT_FAIL)
        address, data = self._registered
        self._registered = None
        self.registers[Register.REGISTERED_INSTRUCTION] = 0
        return self.write(address, data)

    def reboot(self) -> None:
        """Restart: RAM at its power-on values, torque off, errors forgotten."""
        self.registers.reset_ram()
        self._power_on()
        self.ready_ns = self._now_ns() + BOOT_NS

    def factory_reset(self, keep_id: bool, keep_baud: bool) -> None:
        """EEPROM at its factory values, but for what is kept, and restart."""
        kept = [Register.ID] * keep_id + [Register.BAUD_RATE] * keep_baud
        values = {register: self.registers[register] for register in kept}
        self.registers.reset_eeprom()
        for register, value in values.items():
            self.registers[register] = value
        self.reboot()

    def clear(self, params: bytes) -> int:
        """Clear the turns of the position, of which a joint has none; the error byte."""
        return self.error(StatusError.NONE if params == _CLEAR_POSITION else StatusError.DATA_RANGE)

    # Writing ---------------------------------------------------------------------------------

    def _take_goal(self, data: bytes) -> bool:
        """A Goal Position alone, as a driver writes it in every tick; False if it is refused."""
        (goal,) = _GOAL_POSITION.unpack(data)
        low, high = self.registers.goal_bounds
        if not low <= goal <= high or self._memory[_WATCHDOG] == WATCHDOG_TRIPPED:
            return False
        self._memory[_GOAL_ADDRESS : _GOAL_ADDRESS + _GOAL_POSITION.size] = data
        self._new_goal()
        return True

    def _write_run(self, address: int, data: bytes) -> StatusError:
        """Check and write bytes at their real addresses, then do what they ask for."""
        if self.registers.points_indirect(address, len(data)):
            self._memory[address : address + len(data)] = data
            return StatusError.NONE
        plan = write_plan(self.registers.model.name, address, len(data))
        if isinstance(plan, StatusError):
            return plan
        problem = self._check(plan, address, data)
        if problem:
            return problem
        for row in plan:
            begin = row.address - address
            self._memory[row.address : row.address + row.size] = data[begin : begin + row.size]
        for row in plan:
            effect = self._effects.get(row.address)
            if effect is not None:
                effect()
        return StatusError.NONE

    def _check(self, plan: Rows, address: int, data: bytes) -> StatusError:
        if self._memory[_TORQUE] and plan[0].address < EEPROM_END:
            return StatusError.ACCESS
        tripped = self._memory[_WATCHDOG] == WATCHDOG_TRIPPED
        for row in plan:
            if tripped and _GOALS <= row.address < _GOALS_END:
                return StatusError.DATA_RANGE
            begin = row.address - address
            value = row.decode(data[begin : begin + row.size])
            problem = check_value(row, value, self.registers)
            if problem:
                return problem
        return StatusError.NONE

    def _adopt_settings(self) -> None:
        registers = self.registers
        registers.adopt_mode()
        self.id, self.baud_code = registers[Register.ID], registers[Register.BAUD_RATE]
        self.return_delay = registers[Register.RETURN_DELAY_TIME]
        self.status_level = registers[Register.STATUS_RETURN_LEVEL]
        mode = registers[Register.OPERATING_MODE]
        offset = registers[Register.HOMING_OFFSET]
        ignored = mode == OperatingMode.POSITION and abs(offset) > _SINGLE_TURN_OFFSET
        self._offset = CENTRE_COUNTS + (0 if ignored else offset)
        drive_mode = registers[Register.DRIVE_MODE]
        self._sign = -1 if drive_mode & DriveMode.REVERSE else 1
        self._drives = mode in _POSITION_MODES
        self._torque_on_by_goal = drive_mode & DriveMode.TORQUE_ON_BY_GOAL_UPDATE
        self._threshold = registers[Register.MOVING_THRESHOLD]
        self._hottest = registers[Register.TEMPERATURE_LIMIT]
        self._lowest = registers[Register.MIN_VOLTAGE_LIMIT]
        self._highest = registers[Register.MAX_VOLTAGE_LIMIT]

    def _change_mode(self) -> None:
        self._adopt_settings()
        self.registers.reset_control()
        self._adopt_gains()

    def _change_limits(self) -> None:
        self.registers.reset_goals()
        self._adopt_gains()

    def _switch_torque(self) -> None:
        if self._latched:
            self._memory[_TORQUE] = 0
        self._motor.enable(bool(self._memory[_TORQUE]))

    def _adopt_gains(self) -> None:
        registers = self.registers
        self._motor.set_gains(
            registers[Register.POSITION_P_GAIN],
            registers[Register.POSITION_D_GAIN],
            abs(registers[Register.GOAL_PWM]) if self._drives else 0,
        )

    def _new_goal(self) -> None:
        self._adopt_goal()
        if self._torque_on_by_goal and not self._memory[_TORQUE]:
            self._memory[_TORQUE] = 1
            self._switch_torque()

    def _adopt_goal(self) -> None:
        (self._goal,) = _GOAL_POSITION.unpack_from(self._memory, _GOAL_ADDRESS)
        self._motor.set_goal(self._sign * (self._goal - self._offset) + CENTRE_COUNTS)

    # Bus watchdog ----------------------------------------------------------------------------

    def _arm_watchdog(self) -> None:
        self.watchdog_ns = self._memory[_WATCHDOG] * WATCHDOG_UNIT_NS
        """Silence on the bus after which it stops [ns]; 0 while it does not watch."""
        self.on_watchdog()

    def trip(self) -> None:
        """The bus was silent for too long: with torque on, stop, and take no goals any more."""
        if not self._memory[_TORQUE]:
            return
        self._memory[_WATCHDOG] = WATCHDOG_TRIPPED
        self.watchdog_ns = 0
        self._motor.set_goal(self._motor.reading().position)

    # Measuring -------------------------------------------------------------------------------

    def _shown(self, reading: Reading) -> int:
        """Present Position: the encoder through drive mode and homing offset."""
        return self._sign * (reading.position - CENTRE_COUNTS) + self._offset

    def _measure(self) -> None:
        """Bring the measured registers, and the hardware error, to the last grid point."""
        pwm, current, velocity, position, voltage, temperature = self._motor.reading()
        sign = self._sign
        velocity *= sign
        tick = (self._now_ns() - self._booted_ns) // 1_000_000 % REALTIME_TICK_MODULUS
        moving = abs(velocity) > self._threshold
        if temperature > self._hottest:
            self._raise(HardwareError.OVERHEATING)
        if not self._lowest <= voltage <= self._highest:
            self._raise(HardwareError.INPUT_VOLTAGE)
        PRESENT.pack_into(
            self._memory, _PRESENT, tick, moving, 0, sign * pwm, sign * current, velocity,
            sign * (position - CENTRE_COUNTS) + self._offset, 0, self._goal, voltage, temperature,
        )  # fmt: skip

    def _raise(self, error: HardwareError) -> None:
        """Latch a hardware error; one that the Shutdown mask holds ends the torque."""
        self._memory[_ERROR] |= error
        if self.registers[Register.SHUTDOWN] & error:
            self._latched = True
            self._memory[_TORQUE] = 0
            self._switch_torque()
