"""Control Table Backup: what an emulated servo keeps, and what it takes back.

ROBOTIS e-manual, Protocol 2.0, Control Table Backup (0x20); Startup Configuration (60).
"""

from drivers.dynamixel.control_table import EEPROM_END, Register
from sim_backends.virtual.register_file import RegisterFile

STORE, RESTORE = b"\x01CTRL", b"\x02CTRL"
"""Parameters of the instruction."""
RESTORE_RAM = 2
"""Bit of Startup Configuration: the backup's RAM values are taken at power-on."""
_RAM = (
    Register.VELOCITY_I_GAIN,
    Register.VELOCITY_P_GAIN,
    Register.POSITION_D_GAIN,
    Register.POSITION_I_GAIN,
    Register.POSITION_P_GAIN,
    Register.FEEDFORWARD_2ND_GAIN,
    Register.FEEDFORWARD_1ST_GAIN,
    Register.PROFILE_ACCELERATION,
    Register.PROFILE_VELOCITY,
)
"""What is kept of the RAM area, beside the indirect addresses."""
_FIRST_SETTING = Register.ID.address


class Backup:
    """The backup area of one servo."""

    def __init__(self, registers: RegisterFile) -> None:
        self._registers = registers
        self._eeprom = b""
        self._ram: dict[Register, int] = {}
        self._indirect: dict[int, bytes] = {}

    @property
    def exists(self) -> bool:
        """Whether something was stored."""
        return bool(self._eeprom)

    def store(self) -> None:
        """Keep the EEPROM area, gains, profile and indirect addresses."""
        registers = self._registers
        self._eeprom = bytes(registers.memory[_FIRST_SETTING:EEPROM_END])
        self._ram = {register: registers[register] for register in _RAM}
        self._indirect = registers.indirect_addresses()

    def restore_eeprom(self) -> None:
        """Take the EEPROM area back."""
        self._registers.memory[_FIRST_SETTING:EEPROM_END] = self._eeprom

    def restore_ram(self) -> None:
        """After power-on: take the RAM values back if Startup Configuration says so."""
        registers = self._registers
        if not registers.firmware.backup:
            return
        registers[Register.BACKUP_READY] = int(self.exists)
        if self.exists and registers[Register.STARTUP_CONFIGURATION] & RESTORE_RAM:
            for register, value in self._ram.items():
                registers[register] = value
            for place, address in self._indirect.items():
                registers.memory[place : place + 2] = address
