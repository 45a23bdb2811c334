"""The memory of one servo's control table: factory values, indirect cells, reads and writes."""

from drivers.dynamixel.control_table import (
    BAUD_CODES,
    EEPROM_END,
    TABLE_SIZE,
    OperatingMode,
    Register,
)
from drivers.dynamixel.servo_models import ServoModel
from sim_backends.virtual.firmware import FIRMWARE, Firmware

_MEASURED, _MEASURED_END = Register.REALTIME_TICK.address, Register.PRESENT_TEMPERATURE.end
EXTENDED_POSITION = 1_048_575
"""Largest Goal Position outside the position mode (256 turns)."""
_CONTROL = (
    Register.POSITION_P_GAIN,
    Register.POSITION_I_GAIN,
    Register.POSITION_D_GAIN,
    Register.VELOCITY_P_GAIN,
    Register.VELOCITY_I_GAIN,
    Register.FEEDFORWARD_1ST_GAIN,
    Register.FEEDFORWARD_2ND_GAIN,
    Register.PROFILE_ACCELERATION,
    Register.PROFILE_VELOCITY,
)
"""What a change of the operating mode resets, beside the goals (e-manual, Operating Mode)."""


class RegisterFile:
    """Bytes of one control table. An indirect data byte is the byte that its address points at."""

    def __init__(
        self, model: ServoModel, servo_id: int, baud: int, firmware: int = FIRMWARE
    ) -> None:
        """A servo set up for a robot: its id and baud, no return delay, else as from factory."""
        self.model = model
        self.goal_bounds = (0, 0)
        """Least and greatest Goal Position of the operating mode; see `adopt_mode`."""
        self.memory = bytearray(TABLE_SIZE)
        self.install(firmware)
        self.reset_eeprom()
        self[Register.ID] = servo_id
        self[Register.BAUD_RATE] = BAUD_CODES[baud]
        self[Register.RETURN_DELAY_TIME] = 0
        self.reset_ram()

    def install(self, firmware: int) -> None:
        """Another firmware version; the RAM area needs a reset then."""
        self.firmware = Firmware(self.model, firmware)
        self._places = {
            cells.data + i: cells.address + 2 * i
            for cells in self.firmware.indirect
            for i in range(cells.count)
        }
        """From an indirect data byte to the place of the address that it follows."""
        self._first_place = min(self._places.values())
        self._first_data = min(self._places)
        self[Register.FIRMWARE_VERSION] = firmware

    def __getitem__(self, register: Register) -> int:
        row = register.spec
        return row.decode(bytes(self.memory[row.address : row.address + row.size]))

    def __setitem__(self, register: Register, value: int) -> None:
        row = register.spec
        self.memory[row.address : row.address + row.size] = row.encode(value)

    def reset_eeprom(self) -> None:
        """Factory values of the EEPROM area."""
        for register in Register:
            if register.address < EEPROM_END:
                self[register] = self.model.initial(register) or 0
        self[Register.FIRMWARE_VERSION] = self.firmware.version

    def reset_ram(self) -> None:
        """Power-on values of the RAM area; indirect addresses point at their own data."""
        self.memory[EEPROM_END:] = bytes(TABLE_SIZE - EEPROM_END)
        for register in Register:
            if register.address >= EEPROM_END:
                self[register] = self.model.initial(register) or 0
        self.reset_goals()
        for data, place in self._places.items():
            self.memory[place : place + 2] = data.to_bytes(2, "little")

    def adopt_mode(self) -> None:
        """Bring `goal_bounds` up to date with operating mode and position limits."""
        if self[Register.OPERATING_MODE] == OperatingMode.POSITION:
            low, high = self[Register.MIN_POSITION_LIMIT], self[Register.MAX_POSITION_LIMIT]
            self.goal_bounds = (low, high)
        else:
            self.goal_bounds = (-EXTENDED_POSITION, EXTENDED_POSITION)

    def reset_control(self) -> None:
        """What a change of the operating mode sets back."""
        for register in _CONTROL:
            self[register] = self.model.initial(register) or 0
        self.reset_goals()

    def reset_goals(self) -> None:
        """Goal PWM and current at their limits, goal velocity 0."""
        self[Register.GOAL_PWM] = self[Register.PWM_LIMIT]
        self[Register.GOAL_CURRENT] = self[Register.CURRENT_LIMIT]
        self[Register.GOAL_VELOCITY] = 0

    def read(self, address: int, length: int) -> bytes | None:
        """Bytes of a range, indirect data followed; None outside the table or for no bytes."""
        end = address + length
        if length == 0 or end > TABLE_SIZE:
            return None
        if end <= self._first_data:
            return bytes(self.memory[address:end])
        return bytes(self.memory[self.resolve(cell)] for cell in range(address, end))

    def resolve(self, address: int) -> int:
        """Where an address leads: elsewhere for an indirect data byte."""
        place = self._places.get(address)
        if place is None:
            return address
        target = int.from_bytes(self.memory[place : place + 2], "little")
        return target if target < TABLE_SIZE else address

    def reaches_present(self, address: int, length: int) -> bool:
        """Whether a read may touch measured values, directly or through indirect data."""
        end = address + length
        return end > self._first_data or (end > _MEASURED and address < _MEASURED_END)

    def split_indirect(self, address: int, data: bytes) -> list[tuple[int, bytes]] | None:
        """A write's runs of real addresses; None when it has no indirect data bytes."""
        if address + len(data) <= self._first_data:
            return None
        cells = range(address, address + len(data))
        if not any(cell in self._places for cell in cells):
            return None
        runs: list[tuple[int, bytes]] = []
        for cell, byte in zip(cells, data, strict=True):
            target = self.resolve(cell)
            if runs and runs[-1][0] + len(runs[-1][1]) == target:
                runs[-1] = (runs[-1][0], runs[-1][1] + bytes((byte,)))
            else:
                runs.append((target, bytes((byte,))))
        return runs

    def indirect_addresses(self) -> dict[int, bytes]:
        """What is in every indirect address, by its place."""
        return {place: bytes(self.memory[place : place + 2]) for place in self._places.values()}

    def points_indirect(self, address: int, length: int) -> bool:
        """Whether a range lies within indirect addresses, and covers whole ones."""
        if address < self._first_place:
            return False
        return any(
            cells.address <= address and address + length <= cells.address + 2 * cells.count
            for cells in self.firmware.indirect
        ) and not (address % 2 or length % 2)
