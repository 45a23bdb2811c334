"""The group read of one tick: its request bytes, and its answer taken apart all at once.

Every servo is asked for the contiguous block Present Current, Velocity and Position (126 to 135).
Slow registers ride along: in some ticks the last servo of the chain is asked for a longer block
that begins or ends with the same ten bytes. That costs 11 bytes in one tick of ten, where indirect
addressing would cost 5 bytes a servo in every tick and a set-up that each reboot undoes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.dynamixel.budget import BusTiming, reply_size, wire_time_ns
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import (
    FastBlock,
    encode_bulk_read,
    encode_sync_read,
    fast_status_start,
)
from hil.interface import Ints


@dataclass(frozen=True, slots=True)
class Block:
    """A contiguous run of registers."""

    address: int
    length: int

    @classmethod
    def spanning(cls, first: Register, last: Register) -> "Block":
        """From one register to another, both included."""
        return cls(first.address, last.end - first.address)

    def value(self, register: Register, data: bytes) -> int:
        """A register's value in the block's data."""
        start = register.address - self.address
        return register.spec.decode(data[start : start + register.size])


HOT = Block.spanning(Register.PRESENT_CURRENT, Register.PRESENT_POSITION)
SLOW = Block.spanning(Register.PRESENT_CURRENT, Register.PRESENT_TEMPERATURE)
"""Adds voltage and temperature."""
FAULT = Block.spanning(Register.HARDWARE_ERROR_STATUS, Register.PRESENT_TEMPERATURE)
"""Adds the cause of an alert."""

HOT_DTYPE = np.dtype(
    [
        ("error", "u1"),
        ("id", "u1"),
        ("current", "<i2"),
        ("velocity", "<i4"),
        ("position", "<i4"),
        ("crc", "<u2"),
    ]
)
"""One fast block of the hot registers."""


@dataclass(frozen=True, slots=True)
class BusServo:
    """One servo of a bus."""

    id: int
    joint: int
    """Index in joint order."""


@dataclass(frozen=True, slots=True)
class ReadPlan:
    """Who is asked in one tick, in which order, and what comes back."""

    members: tuple[int, ...]
    """Places of the servos on the bus, in the order of their answers."""
    ids: tuple[int, ...]
    id_bytes: bytes
    joints: Ints
    """Their indices in joint order."""
    last: Block
    """What the last servo is asked for; HOT in most ticks."""
    lengths: tuple[int, ...]
    fast: bool
    packet: bytes
    start: bytes
    """First bytes of a fast answer."""
    reply_size: int
    timeout_ns: int
    """From sending the request to giving up."""
    sample_delay_ns: int
    """From sending the request to the servos' sampling."""


def plan_read(
    members: tuple[int, ...],
    servos: Sequence[BusServo],
    last: Block,
    fast: bool,
    timing: BusTiming,
    margin_ns: int,
) -> ReadPlan:
    """The read of `members`, which are `servos`; `margin_ns` is added to the timeout."""
    ids = tuple(servo.id for servo in servos)
    lengths = (HOT.length,) * (len(ids) - 1) + (last.length,)
    if last is HOT:
        packet = encode_sync_read(ids, HOT.address, HOT.length, fast)
    else:
        items = [(servo_id, HOT.address, HOT.length) for servo_id in ids[:-1]]
        packet = encode_bulk_read([*items, (ids[-1], last.address, last.length)], fast)
    size = reply_size(lengths, fast)
    timeout = timing.read_time_ns(len(packet), size, len(ids), fast) + margin_ns
    return ReadPlan(
        members=members,
        ids=ids,
        id_bytes=bytes(ids),
        joints=np.array([servo.joint for servo in servos], dtype=np.int64),
        last=last,
        lengths=lengths,
        fast=fast,
        packet=packet,
        start=fast_status_start(lengths),
        reply_size=size,
        timeout_ns=timeout,
        sample_delay_ns=timing.usb_transfer_ns + wire_time_ns(len(packet), timing.baud),
    )


def hot_values(block: Block, servo: FastBlock) -> tuple[int, int, int]:
    """Present current, velocity and position in a block of any kind."""
    return (
        block.value(Register.PRESENT_CURRENT, servo.data),
        block.value(Register.PRESENT_VELOCITY, servo.data),
        block.value(Register.PRESENT_POSITION, servo.data),
    )
