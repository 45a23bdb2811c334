"""The group read of one tick: its request bytes, and its answer taken apart all at once.

Every servo is asked for the contiguous block Realtime Tick to Present Position (120 to 135): what
it measures, and when, by its own clock. Everything slower is read in idle time (`idle_read`).
Indirect addressing would save 4 bytes a servo, and needs a set-up that each reboot undoes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.dynamixel.blocks import HOT
from drivers.dynamixel.budget import BusTiming, reply_size, wire_time_ns
from drivers.dynamixel.protocol import encode_sync_read, fast_status_start
from hil.interface import Ints

FAST_DTYPE = np.dtype(
    [
        ("error_id", "<u2"),
        ("tick", "<u2"),
        ("moving", "u1"),
        ("moving_status", "u1"),
        ("pwm", "<i2"),
        ("current", "<i2"),
        ("velocity", "<i4"),
        ("position", "<i4"),
        ("crc", "<u2"),
    ]
)
"""One servo's part of a fast answer."""
FAST_START = 8
"""Bytes of a fast answer before its first block."""


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
    unmarked: bytes
    """Error byte 0 and id of every member, as they come in fast answers."""
    places: slice | Ints
    """The members as an index of arrays by place."""
    joints: slice | Ints
    """Their joints as an index of arrays in joint order."""
    fast: bool
    packet: bytes
    start: bytes
    """First bytes of a fast answer."""
    reply_size: int
    timeout_ns: int
    """From sending the request to giving up."""
    sample_delay_ns: int
    """From sending the request to the servos' sampling."""

    @property
    def lengths(self) -> tuple[int, ...]:
        """Data bytes asked of each servo."""
        return (HOT.length,) * len(self.ids)


def plan_read(
    members: tuple[int, ...],
    servos: Sequence[BusServo],
    fast: bool,
    timing: BusTiming,
    margin_ns: int,
) -> ReadPlan:
    """The read of `members`, which are `servos`; `margin_ns` is added to the timeout."""
    ids = tuple(servo.id for servo in servos)
    lengths = (HOT.length,) * len(ids)
    packet = encode_sync_read(ids, HOT.address, HOT.length, fast)
    size = reply_size(lengths, fast)
    timeout = timing.read_time_ns(len(packet), size, len(ids), fast) + margin_ns
    return ReadPlan(
        members=members,
        ids=ids,
        id_bytes=bytes(ids),
        unmarked=b"".join(bytes((0, servo_id)) for servo_id in ids),
        places=_index(members),
        joints=_index([servo.joint for servo in servos]),
        fast=fast,
        packet=packet,
        start=fast_status_start(lengths),
        reply_size=size,
        timeout_ns=timeout,
        sample_delay_ns=timing.usb_transfer_ns + wire_time_ns(len(packet), timing.baud),
    )


def _index(numbers: Sequence[int]) -> slice | Ints:
    """An index of arrays; a slice, which is faster, where the numbers are consecutive."""
    first, last = numbers[0], numbers[-1]
    if list(numbers) == list(range(first, last + 1)):
        return slice(first, last + 1)
    if list(numbers) == list(range(first, last - 1, -1)):
        return slice(first, last - 1 if last else None, -1)
    return np.array(numbers, dtype=np.int64)
