"""The runs of registers that the driver reads: hot ones in every tick, slow ones in idle time."""

from dataclasses import dataclass
from struct import Struct
from typing import NamedTuple

from drivers.dynamixel.control_table import Register


@dataclass(frozen=True, slots=True)
class Block:
    """A contiguous run of registers."""

    address: int
    length: int

    @classmethod
    def spanning(cls, first: Register, last: Register) -> "Block":
        """From one register to another, both included."""
        return cls(first.address, last.end - first.address)


HOT = Block.spanning(Register.REALTIME_TICK, Register.PRESENT_POSITION)
"""What a servo measures, and when by its own clock."""
STATE = Block.spanning(Register.TORQUE_ENABLE, Register.HARDWARE_ERROR_STATUS)
GAINS = Block.spanning(Register.POSITION_D_GAIN, Register.GOAL_PWM)
"""Gains, watchdog and drive limit as the servo has them."""
SLOW = Block.spanning(Register.PRESENT_INPUT_VOLTAGE, Register.PRESENT_TEMPERATURE)
WHOLE = Block.spanning(Register.TORQUE_ENABLE, Register.PRESENT_TEMPERATURE)
"""State, gains and slow values at once, where a bus has the time."""
IN_TURN = (STATE, GAINS, SLOW)
"""Where it has not."""


class SlowRegisters(NamedTuple):
    """What a servo says of itself in idle time; None for what it was not asked."""

    torque: int | None = None
    hardware_error: int | None = None
    d_gain: int | None = None
    p_gain: int | None = None
    watchdog: int | None = None
    goal_pwm: int | None = None
    voltage: int | None = None
    """[0.1 V]"""
    temperature: int | None = None
    """[°C]"""


# Offsets follow from the addresses: 64, 70 · 80, 84, 98, 100 · 144, 146.
_STATE, _GAINS, _SLOW = Struct("<B5xB"), Struct("<H2xH12xBxH"), Struct("<HB")
_WHOLE = Struct("<B5xB9xH2xH12xBxH42xHB")


def decode_slow(block: Block, data: bytes) -> SlowRegisters:
    """The registers in a block's data, which is as long as it should be."""
    if block is WHOLE:
        return SlowRegisters(*_WHOLE.unpack(data))
    if block is STATE:
        return SlowRegisters(*_STATE.unpack(data))
    if block is GAINS:
        return SlowRegisters(None, None, *_GAINS.unpack(data))
    voltage, temperature = _SLOW.unpack(data)
    return SlowRegisters(voltage=voltage, temperature=temperature)
