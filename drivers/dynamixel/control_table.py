"""The X-series control table as data: registers, modes, error bits, baud codes.

Source: ROBOTIS e-manual, control table pages of the X series. What differs between models
(initial gains, limits, baud codes) is in `servo_models`.
"""

from dataclasses import dataclass
from enum import Enum, IntEnum, IntFlag

import numpy as np

TABLE_SIZE = 662
"""Bytes of the largest X-series table: addresses 0 to 661."""
EEPROM_END = 64
"""Addresses below are EEPROM, writable only with torque off; the others are RAM."""

RPM = 2 * np.pi / 60
POSITION_UNIT = 2 * np.pi / 4096
"""[rad] of one count."""
VELOCITY_UNIT = 0.229 * RPM
"""[rad/s] of one velocity unit, 0.229 rev/min."""
VOLTAGE_UNIT = 0.1
"""[V]"""
WATCHDOG_UNIT_NS = 20_000_000
"""[ns] of one Bus Watchdog unit."""
RETURN_DELAY_UNIT_NS = 2_000
"""[ns] of one Return Delay Time unit."""
WATCHDOG_TRIPPED = 0xFF
"""What Bus Watchdog reads after it tripped (-1)."""
REALTIME_TICK_MODULUS = 32768
"""Realtime Tick counts 1 ms and wraps after 32767."""


class Access(Enum):
    """What the bus may do with a register."""

    READ = "R"
    READ_WRITE = "RW"


class Area(Enum):
    """Where a register lives."""

    EEPROM = "EEPROM"
    RAM = "RAM"


@dataclass(frozen=True, slots=True)
class RegisterSpec:
    """One row of the control table."""

    name: str
    """Name in the e-manual."""
    address: int
    size: int
    """Bytes: 1, 2 or 4, little-endian."""
    access: Access
    initial: int | None
    """Factory value; None where it differs per model or is a measurement."""
    minimum: int | None
    """Smallest value accepted; None where another register or the model bounds it."""
    maximum: int | None
    """Largest value accepted; None where another register or the model bounds it."""
    signed: bool = False
    unit: str = ""
    """SI unit of `value * scale`; empty for codes, flags and pure numbers."""
    scale: float = 1.0
    """SI value of one register unit; 1 where the model decides (currents)."""

    @property
    def area(self) -> Area:
        """EEPROM or RAM, by address."""
        return Area.EEPROM if self.address < EEPROM_END else Area.RAM

    def encode(self, value: int) -> bytes:
        """The register's bytes of a value. Raises OverflowError if it does not fit."""
        return value.to_bytes(self.size, "little", signed=self.signed)

    def decode(self, data: bytes) -> int:
        """The value in the register's bytes."""
        return int.from_bytes(data, "little", signed=self.signed)


_R = Access.READ
_RW = Access.READ_WRITE
_ROW = RegisterSpec


class Register(Enum):
    """Every register of the X series, as rows of the table."""

    MODEL_NUMBER = _ROW("Model Number", 0, 2, _R, None, None, None)
    MODEL_INFORMATION = _ROW("Model Information", 2, 4, _R, None, None, None)
    FIRMWARE_VERSION = _ROW("Firmware Version", 6, 1, _R, None, None, None)
    ID = _ROW("ID", 7, 1, _RW, 1, 0, 252)
    BAUD_RATE = _ROW("Baud Rate", 8, 1, _RW, 1, 0, None)
    RETURN_DELAY_TIME = _ROW("Return Delay Time", 9, 1, _RW, 250, 0, 254, unit="s", scale=2e-6)
    DRIVE_MODE = _ROW("Drive Mode", 10, 1, _RW, 0, 0, 13)
    OPERATING_MODE = _ROW("Operating Mode", 11, 1, _RW, 3, 0, 16)
    SHADOW_ID = _ROW("Secondary(Shadow) ID", 12, 1, _RW, 255, 0, 255)
    PROTOCOL_TYPE = _ROW("Protocol Type", 13, 1, _RW, 2, 1, 22)
    HOMING_OFFSET = _ROW(
        "Homing Offset", 20, 4, _RW, 0, -1044479, 1044479, True, "rad", POSITION_UNIT
    )
    MOVING_THRESHOLD = _ROW(
        "Moving Threshold", 24, 4, _RW, 10, 0, 1023, unit="rad/s", scale=VELOCITY_UNIT
    )
    TEMPERATURE_LIMIT = _ROW("Temperature Limit", 31, 1, _RW, None, 0, 100, unit="°C")
    MAX_VOLTAGE_LIMIT = _ROW(
        "Max Voltage Limit", 32, 2, _RW, None, None, None, unit="V", scale=VOLTAGE_UNIT
    )
    MIN_VOLTAGE_LIMIT = _ROW(
        "Min Voltage Limit", 34, 2, _RW, None, None, None, unit="V", scale=VOLTAGE_UNIT
    )
    PWM_LIMIT = _ROW("PWM Limit", 36, 2, _RW, 885, 0, 885, scale=1 / 885)
    CURRENT_LIMIT = _ROW("Current Limit", 38, 2, _RW, None, 0, None, unit="A")
    VELOCITY_LIMIT = _ROW(
        "Velocity Limit", 44, 4, _RW, None, 0, 2047, unit="rad/s", scale=VELOCITY_UNIT
    )
    MAX_POSITION_LIMIT = _ROW(
        "Max Position Limit", 48, 4, _RW, 4095, 0, 4095, unit="rad", scale=POSITION_UNIT
    )
    MIN_POSITION_LIMIT = _ROW(
        "Min Position Limit", 52, 4, _RW, 0, 0, 4095, unit="rad", scale=POSITION_UNIT
    )
    STARTUP_CONFIGURATION = _ROW("Startup Configuration", 60, 1, _RW, 0, 0, 3)
    PWM_SLOPE = _ROW("PWM Slope", 62, 1, _RW, None, 1, 255)
    SHUTDOWN = _ROW("Shutdown", 63, 1, _RW, None, 0, 63)

    TORQUE_ENABLE = _ROW("Torque Enable", 64, 1, _RW, 0, 0, 1)
    LED = _ROW("LED", 65, 1, _RW, 0, 0, 1)
    STATUS_RETURN_LEVEL = _ROW("Status Return Level", 68, 1, _RW, 2, 0, 2)
    REGISTERED_INSTRUCTION = _ROW("Registered Instruction", 69, 1, _R, 0, None, None)
    HARDWARE_ERROR_STATUS = _ROW("Hardware Error Status", 70, 1, _R, 0, None, None)
    VELOCITY_I_GAIN = _ROW("Velocity I Gain", 76, 2, _RW, None, 0, 16383)
    VELOCITY_P_GAIN = _ROW("Velocity P Gain", 78, 2, _RW, None, 0, 16383)
    POSITION_D_GAIN = _ROW("Position D Gain", 80, 2, _RW, None, 0, 16383)
    POSITION_I_GAIN = _ROW("Position I Gain", 82, 2, _RW, None, 0, 16383)
    POSITION_P_GAIN = _ROW("Position P Gain", 84, 2, _RW, None, 0, 16383)
    FEEDFORWARD_2ND_GAIN = _ROW("Feedforward 2nd Gain", 88, 2, _RW, 0, 0, 16383)
    FEEDFORWARD_1ST_GAIN = _ROW("Feedforward 1st Gain", 90, 2, _RW, 0, 0, 16383)
    BUS_WATCHDOG = _ROW("Bus Watchdog", 98, 1, _RW, 0, 0, 127, unit="s", scale=0.02)
    GOAL_PWM = _ROW("Goal PWM", 100, 2, _RW, None, None, None, True, scale=1 / 885)
    GOAL_CURRENT = _ROW("Goal Current", 102, 2, _RW, None, None, None, True, "A")
    GOAL_VELOCITY = _ROW("Goal Velocity", 104, 4, _RW, 0, None, None, True, "rad/s", VELOCITY_UNIT)
    PROFILE_ACCELERATION = _ROW("Profile Acceleration", 108, 4, _RW, 0, 0, 32767)
    PROFILE_VELOCITY = _ROW("Profile Velocity", 112, 4, _RW, 0, 0, 32767)
    GOAL_POSITION = _ROW("Goal Position", 116, 4, _RW, None, None, None, True, "rad", POSITION_UNIT)
    REALTIME_TICK = _ROW("Realtime Tick", 120, 2, _R, None, None, None, unit="s", scale=1e-3)
    MOVING = _ROW("Moving", 122, 1, _R, 0, None, None)
    MOVING_STATUS = _ROW("Moving Status", 123, 1, _R, 0, None, None)
    PRESENT_PWM = _ROW("Present PWM", 124, 2, _R, None, None, None, True, scale=1 / 885)
    PRESENT_CURRENT = _ROW("Present Current", 126, 2, _R, None, None, None, True, "A")
    PRESENT_VELOCITY = _ROW(
        "Present Velocity", 128, 4, _R, None, None, None, True, "rad/s", VELOCITY_UNIT
    )
    PRESENT_POSITION = _ROW(
        "Present Position", 132, 4, _R, None, None, None, True, "rad", POSITION_UNIT
    )
    VELOCITY_TRAJECTORY = _ROW(
        "Velocity Trajectory", 136, 4, _R, None, None, None, True, "rad/s", VELOCITY_UNIT
    )
    POSITION_TRAJECTORY = _ROW(
        "Position Trajectory", 140, 4, _R, None, None, None, True, "rad", POSITION_UNIT
    )
    PRESENT_INPUT_VOLTAGE = _ROW(
        "Present Input Voltage", 144, 2, _R, None, None, None, unit="V", scale=VOLTAGE_UNIT
    )
    PRESENT_TEMPERATURE = _ROW("Present Temperature", 146, 1, _R, None, None, None, unit="°C")
    BACKUP_READY = _ROW("Backup Ready", 147, 1, _R, None, None, None)

    @property
    def spec(self) -> RegisterSpec:
        """The row of the table."""
        return self.value

    @property
    def address(self) -> int:
        """First byte in the table."""
        return self.value.address

    @property
    def size(self) -> int:
        """Bytes."""
        return self.value.size

    @property
    def end(self) -> int:
        """Address after the last byte."""
        return self.value.address + self.value.size


class OperatingMode(IntEnum):
    """Values of Operating Mode (11)."""

    CURRENT = 0
    VELOCITY = 1
    POSITION = 3
    EXTENDED_POSITION = 4
    CURRENT_BASED_POSITION = 5
    PWM = 16


class HardwareError(IntFlag):
    """Bits of Hardware Error Status (70) and of the Shutdown mask (63)."""

    NONE = 0
    INPUT_VOLTAGE = 1
    OVERHEATING = 4
    ENCODER = 8
    ELECTRICAL_SHOCK = 16
    OVERLOAD = 32


class DriveMode(IntFlag):
    """Bits of Drive Mode (10)."""

    NORMAL = 0
    REVERSE = 1
    TIME_BASED_PROFILE = 4
    TORQUE_ON_BY_GOAL_UPDATE = 8


class StatusReturnLevel(IntEnum):
    """Values of Status Return Level (68): which instructions are answered."""

    PING_ONLY = 0
    PING_AND_READ = 1
    ALL = 2


BAUD_CODES = {
    9_600: 0,
    57_600: 1,
    115_200: 2,
    1_000_000: 3,
    2_000_000: 4,
    3_000_000: 5,
    4_000_000: 6,
    4_500_000: 7,
}
"""Value of Baud Rate (8) for each speed [bit/s]; not every model has the last one."""
