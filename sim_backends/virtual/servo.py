"""One emulated Dynamixel: what its firmware does with instructions."""

import struct
from collections.abc import Callable

from drivers.dynamixel.control_table import (
    EEPROM_END,
    WATCHDOG_TRIPPED,
    WATCHDOG_UNIT_NS,
    Register,
)
from drivers.dynamixel.protocol import ALERT, BROADCAST_ID, StatusError
from sim_backends.virtual.backup import RESTORE, STORE, Backup
from sim_backends.virtual.motors import Motor
from sim_backends.virtual.register_file import RegisterFile
from sim_backends.virtual.register_rules import Rows, check_value, write_plan
from sim_backends.virtual.servo_drive import ServoDrive

BOOT_NS = 200_000_000
"""From REBOOT to the first answer [ns]; assumed."""
EEPROM_WRITE_NS = 1_000_000
"""From a write into the EEPROM area to its answer, beside the usual gap [ns]; assumed."""
PROTOCOL_2 = 2
_CLEAR_POSITION = b"\x01\x44\x58\x4c\x22"
_RESETS = {b"\xff": (False, False), b"\x01": (True, False), b"\x02": (True, True)}
"""Parameter of FACTORY_RESET: whether id and baud are kept."""
_TORQUE = Register.TORQUE_ENABLE.address
_ERROR = Register.HARDWARE_ERROR_STATUS.address
_WATCHDOG = Register.BUS_WATCHDOG.address
_GOAL_ADDRESS = Register.GOAL_POSITION.address
_GOAL_POSITION = struct.Struct("<i")
_PRESENT, _PRESENT_END = Register.REALTIME_TICK.address, Register.PRESENT_TEMPERATURE.end
_TRAJECTORIES = Register.VELOCITY_TRAJECTORY.address
_GOALS, _GOALS_END = Register.GOAL_PWM.address, Register.GOAL_POSITION.end


class EmulatedServo:
    """Registers with the firmware's rules, on a motor of the plant.

    Modelled: access rules, EEPROM lock and write time, resets by the operating mode, registered
    writes, alert bit and latched hardware errors, bus watchdog, realtime tick, indirect cells,
    homing offset, drive modes, secondary id, protocol type, backup, and what older firmware lacks.
    Measured registers hold the last physics grid point and, like hardware errors, are looked at
    when they are read.
    """

    def __init__(self, registers: RegisterFile, motor: Motor, now_ns: Callable[[], int]) -> None:
        self.registers = registers
        self.drive = ServoDrive(registers, motor, now_ns)
        self._memory = registers.memory
        self._now_ns = now_ns
        self._backup = Backup(registers)
        self._effects = self._make_effects()
        self.on_watchdog: Callable[[], None] = lambda: None
        """Called when `watchdog_ns` may have changed."""
        self.on_trip: Callable[[], None] = lambda: None
        """Called when its bus watchdog has stopped it."""
        self._mute = False
        self.ready_ns = 0
        """From when on it answers [ns]."""
        self._busy_ns = 0
        self._power_on()

    def _make_effects(self) -> dict[int, Callable[[], None]]:
        drive = self.drive
        eeprom = [register for register in Register if register.address < EEPROM_END]
        gains = [register for register in Register if "Gain" in register.spec.name]
        effects = {
            **dict.fromkeys(eeprom, self._adopt_settings),
            **dict.fromkeys(gains, drive.adopt_gains),
            Register.PROFILE_VELOCITY: drive.adopt_gains,
            Register.PROFILE_ACCELERATION: drive.adopt_gains,
            Register.OPERATING_MODE: drive.change_mode,
            Register.PWM_LIMIT: drive.change_limits,
            Register.STATUS_RETURN_LEVEL: self._adopt_settings,
            Register.TORQUE_ENABLE: drive.switch_torque,
            Register.BUS_WATCHDOG: self._arm_watchdog,
            Register.GOAL_PWM: drive.adopt_goals,
            Register.GOAL_CURRENT: drive.adopt_goals,
            Register.GOAL_VELOCITY: drive.adopt_goals,
            Register.GOAL_POSITION: drive.new_goal,
        }
        return {register.address: effect for register, effect in effects.items()}

    def _power_on(self) -> None:
        self._registered: tuple[int, bytes] | None = None
        self._backup.restore_ram()
        self._tripped = False
        self._adopt_identity()
        self.drive.power_on()
        self._arm_watchdog()

    def _adopt_settings(self) -> None:
        self._adopt_identity()
        self.drive.adopt_settings()

    def _adopt_identity(self) -> None:
        registers = self.registers
        self.id, self.shadow_id = registers[Register.ID], registers[Register.SHADOW_ID]
        self.baud_code = registers[Register.BAUD_RATE]
        self.return_delay = registers[Register.RETURN_DELAY_TIME]
        self.status_level = registers[Register.STATUS_RETURN_LEVEL]
        self._speaks = registers[Register.PROTOCOL_TYPE] == PROTOCOL_2
        self.set_mute(self._mute)

    def set_mute(self, mute: bool) -> None:
        """A fault: it neither hears nor answers."""
        self._mute = mute
        self.deaf = mute or not self._speaks
        """Hears nothing, by a fault or because it speaks another protocol."""

    def take_id(self, servo_id: int) -> None:
        """Another id, without being asked."""
        self.registers[Register.ID] = servo_id
        self._adopt_identity()

    # Instructions ----------------------------------------------------------------------------

    def identity(self) -> bytes:
        """Answer to a ping: model number and firmware."""
        return bytes(self._memory[0:2]) + bytes(self._memory[6:7])

    def error(self, status: StatusError = StatusError.NONE) -> int:
        """Error byte of an answer, with the alert bit."""
        return status | ALERT if self._memory[_ERROR] else int(status)

    def take_busy_ns(self) -> int:
        """How long the last instruction keeps it busy before it answers [ns]."""
        busy_ns, self._busy_ns = self._busy_ns, 0
        return busy_ns

    def read(self, address: int, length: int) -> tuple[int, bytes]:
        """Error byte and data of a read."""
        end = address + length
        if _PRESENT <= address < end <= _TRAJECTORIES:  # What a driver reads in every tick.
            self.drive.measure()
            return ALERT if self._memory[_ERROR] else 0, bytes(self._memory[address:end])
        if self.registers.reaches_present(address, length):
            self.drive.measure()
            self.drive.measure_trajectory()
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

    def factory_reset(self, params: bytes, addressed: int) -> int:
        """EEPROM at its factory values, but for what is kept, and restart; the error byte."""
        if params not in _RESETS:
            return self.error(StatusError.DATA_RANGE)
        keep_id, keep_baud = _RESETS[params]
        if addressed == BROADCAST_ID and not keep_id and self.registers.firmware.safe_reset:
            return self.error(StatusError.RESULT_FAIL)
        kept = [Register.ID] * keep_id + [Register.BAUD_RATE] * keep_baud
        values = {register: self.registers[register] for register in kept}
        self.registers.reset_eeprom()
        for register, value in values.items():
            self.registers[register] = value
        self.reboot()
        return self.error()

    def clear(self, params: bytes) -> int:
        """Clear the turns of the position, of which a joint has none; the error byte."""
        if not self.registers.firmware.clear:
            return self.error(StatusError.INSTRUCTION)
        if params != _CLEAR_POSITION:
            return self.error(StatusError.DATA_RANGE)
        self.drive.measure()
        moving = self.registers[Register.MOVING]
        return self.error(StatusError.RESULT_FAIL if moving else StatusError.NONE)

    def back_up(self, params: bytes) -> int:
        """Store the control table, or restore it and restart; the error byte."""
        if not self.registers.firmware.backup:
            return self.error(StatusError.INSTRUCTION)
        if params not in (STORE, RESTORE):
            return self.error(StatusError.DATA_RANGE)
        if self._memory[_TORQUE] or (params == RESTORE and not self._backup.exists):
            return self.error(StatusError.RESULT_FAIL)
        if params == STORE:
            self._backup.store()
            self.registers[Register.BACKUP_READY] = 1
            self._busy_ns = EEPROM_WRITE_NS
        else:
            self._backup.restore_eeprom()
            self.reboot()
        return self.error()

    # Writing ---------------------------------------------------------------------------------

    def _take_goal(self, data: bytes) -> bool:
        """A Goal Position alone, as a driver writes it in every tick; False if it is refused."""
        (goal,) = _GOAL_POSITION.unpack(data)
        low, high = self.registers.goal_bounds
        if not low <= goal <= high or self._memory[_WATCHDOG] == WATCHDOG_TRIPPED:
            return False
        self._memory[_GOAL_ADDRESS : _GOAL_ADDRESS + _GOAL_POSITION.size] = data
        self.drive.new_goal()
        return True

    def _write_run(self, address: int, data: bytes) -> StatusError:
        """Check and write bytes at their real addresses, then do what they ask for."""
        if self.registers.points_indirect(address, len(data)):
            self._memory[address : address + len(data)] = data
            return StatusError.NONE
        plan = write_plan(self.registers.firmware.registers, address, len(data))
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
        if plan[0].address < EEPROM_END:
            self._busy_ns = EEPROM_WRITE_NS
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

    # Bus watchdog ----------------------------------------------------------------------------

    def _arm_watchdog(self) -> None:
        if self._tripped and not self._memory[_WATCHDOG]:
            self.drive.adopt_gains()  # The profile counts again.
        self._tripped = False
        self.watchdog_ns = self._memory[_WATCHDOG] * WATCHDOG_UNIT_NS
        """Silence on the bus after which it stops [ns]; 0 while it does not watch."""
        self.on_watchdog()

    def trip(self) -> None:
        """The bus was silent for too long: with torque on, stop, and take no goals any more."""
        if not self._memory[_TORQUE]:
            return
        self._memory[_WATCHDOG] = WATCHDOG_TRIPPED
        self._tripped = True
        self.watchdog_ns = 0
        self.drive.hold()
        self.on_trip()
