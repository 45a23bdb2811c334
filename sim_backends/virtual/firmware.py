"""What an emulated servo's firmware can do, by its version: features of models as data."""

from drivers.dynamixel.control_table import DriveMode, Register
from drivers.dynamixel.servo_models import ServoModel

FIRMWARE = 48
"""Firmware Version of emulated servos, if nobody asks for another: has every feature (assumed)."""
CLEAR, SAFE_RESET, TIME_BASED_PROFILE = 42, 42, 42
"""First firmware with the CLEAR instruction, of the refusal to reset everybody to id 1 (e-manual,
Protocol 2.0, Clear and Factory Reset), and with time-based profiles (Drive Mode)."""
_NEVER = 256


class Firmware:
    """Features of one version on one model."""

    def __init__(self, model: ServoModel, version: int) -> None:
        newest = model.startup_firmware or _NEVER
        self.version = version
        self.fast_reads = model.supports_fast_read(version)
        self.backup = version >= newest
        """Whether it knows Control Table Backup and Startup Configuration."""
        self.clear = version >= CLEAR
        self.safe_reset = version >= SAFE_RESET
        """Whether it refuses to reset its id when everybody is told to."""
        missing = set(Register) - model.registers
        if version < model.watchdog_firmware:
            missing.add(Register.BUS_WATCHDOG)
        if not self.backup:
            missing |= {Register.STARTUP_CONFIGURATION, Register.BACKUP_READY}
        self.registers = frozenset(set(Register) - missing)
        self.indirect = model.indirect_for(version)
        drive_modes = DriveMode.REVERSE
        if version >= TIME_BASED_PROFILE:
            drive_modes |= DriveMode.TIME_BASED_PROFILE
        if self.backup:  # The same firmware brought both (e-manual, Drive Mode).
            drive_modes |= DriveMode.TORQUE_ON_BY_GOAL_UPDATE
        self.drive_modes = int(drive_modes)
        """Bits that Drive Mode takes."""
