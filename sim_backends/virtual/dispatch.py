"""Instruction packets to servos, and their answers in the order of the wire."""

import struct
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from drivers.dynamixel.control_table import (
    EEPROM_END,
    RETURN_DELAY_UNIT_NS,
    TABLE_SIZE,
    StatusReturnLevel,
)
from drivers.dynamixel.protocol import (
    BROADCAST_ID,
    MAX_ID,
    Instruction,
    Packet,
    crc16,
    encode_status,
    fast_status_block,
    fast_status_start,
)
from sim_backends.virtual.servo import EmulatedServo
from sim_backends.virtual.single_instructions import SINGLE, refuse

TURNAROUND_NS = 20_000
"""From the end of a packet to the answer of a servo with Return Delay Time 0 (assumed)."""
PING_SLOT_NS = 3_000_000
"""A broadcast ping is answered by id i no sooner than i slots later; assumed, because the SDK
waits 3 ms for each id there can be (DynamixelSDK, broadcastPing)."""
_IDLE = b"\xff"
"""What a wire carries on which nobody sends."""
_WORDS = struct.Struct("<HH")
_ITEM = struct.Struct("<BHH")

Items = tuple[tuple[int, int, int], ...]
"""Id, address and length for every servo of a group read."""


class Reply(NamedTuple):
    """What one servo sends."""

    gap_ns: int
    """Silence before it [ns]."""
    data: bytes
    slot_ns: int = 0
    """Earliest start, after the request [ns]."""


class Dispatcher:
    """Protocol 2.0 instructions (ROBOTIS e-manual) for the servos of one wire.

    Group reads are answered in the order of the request; where one servo does not answer, those
    behind it stay silent too (ROBOTIS in DynamixelSDK issue 364). A fast read is one packet that
    the servos write together, so it ends at that place; one for more bytes than fit a packet is
    not answered (assumed). Group writes are not answered at all. Two servos of one id both obey,
    and their answers collide.
    """

    def __init__(self, servos: Sequence[EmulatedServo]) -> None:
        self._servos = tuple(servos)
        self._hearing: dict[int, EmulatedServo] = {}
        self._now_ns = 0
        self._groups: dict[int, Callable[[bytes], list[Reply]]] = {
            Instruction.SYNC_READ: lambda params: self._read_chain(_sync_items(params)),
            Instruction.FAST_SYNC_READ: lambda params: self._read_fast(_sync_items(params)),
            Instruction.BULK_READ: lambda params: self._read_chain(_bulk_items(params)),
            Instruction.FAST_BULK_READ: lambda params: self._read_fast(_bulk_items(params)),
            Instruction.SYNC_WRITE: self._write_sync,
            Instruction.BULK_WRITE: self._write_bulk,
        }

    def handle(self, packet: Packet, baud_code: int, now_ns: int) -> list[Reply]:
        """What the servos answer to a packet that came at a baud and a time."""
        self._now_ns = now_ns
        hearing = [
            servo
            for servo in self._servos
            if servo.baud_code == baud_code and servo.ready_ns <= now_ns and not servo.deaf
        ]
        self._hearing = {servo.id: servo for servo in hearing}
        replies = self._dispatch(packet)
        if len(self._hearing) < len(hearing):
            self._hearing = {servo.id: servo for servo in reversed(hearing)}
            replies = _collided(replies, self._dispatch(packet))
        return replies

    def _dispatch(self, packet: Packet) -> list[Reply]:
        group = self._groups.get(packet.instruction)
        if group is not None:
            return group(packet.params)
        if packet.instruction == Instruction.PING:
            return self._ping(packet.id)
        if packet.id == BROADCAST_ID:
            return self._tell_all(packet)
        return self._ask(packet)

    def _ping(self, servo_id: int) -> list[Reply]:
        """A broadcast ping is answered by all servos, in the order of their ids."""
        wanted = sorted(self._hearing) if servo_id == BROADCAST_ID else [servo_id]
        servos = [self._hearing[key] for key in wanted if key in self._hearing]
        return [
            Reply(
                _gap_ns(servo),
                encode_status(servo.id, servo.error(), servo.identity()),
                PING_SLOT_NS * servo.id if servo_id == BROADCAST_ID else 0,
            )
            for servo in servos
        ]

    def _tell_all(self, packet: Packet) -> list[Reply]:
        """An instruction to everybody, which nobody answers."""
        action = SINGLE.get(packet.instruction)
        for servo in self._hearing.values():
            if action is not None:
                action(servo, packet)
                self._keep_busy(servo)
        return []

    def _keep_busy(self, servo: EmulatedServo) -> None:
        """A write into the EEPROM area that nobody waits for: the servo is deaf meanwhile."""
        busy_ns = servo.take_busy_ns()
        if busy_ns:
            servo.ready_ns = self._now_ns + busy_ns

    def _ask(self, packet: Packet) -> list[Reply]:
        """An instruction to one servo."""
        servo = self._hearing.get(packet.id)
        if packet.instruction == Instruction.STATUS:
            return []
        if servo is None:
            return self._tell_shadows(packet)
        gap_ns, level = _gap_ns(servo), servo.status_level
        action = SINGLE.get(packet.instruction, refuse)
        error, data = action(servo, packet)
        gap_ns += servo.take_busy_ns()
        wanted = StatusReturnLevel.ALL
        if packet.instruction == Instruction.READ:
            wanted = StatusReturnLevel.PING_AND_READ
        if level < wanted:
            return []
        return [Reply(gap_ns, encode_status(packet.id, error, data))]

    def _tell_shadows(self, packet: Packet) -> list[Reply]:
        """Servos whose secondary id it is obey and do not answer (e-manual, Secondary ID)."""
        action = SINGLE.get(packet.instruction)
        for servo in self._shadows(packet.id):
            if action is not None:
                action(servo, packet)
                self._keep_busy(servo)
        return []

    def _shadows(self, servo_id: int) -> list[EmulatedServo]:
        return [servo for servo in self._hearing.values() if servo.shadow_id == servo_id <= MAX_ID]

    def _readers(self, items: Items) -> Iterator[tuple[EmulatedServo, int, int]]:
        """Servos that answer a group read: up to the first silent one."""
        for servo_id, address, length in items:
            servo = self._hearing.get(servo_id)
            if servo is None or servo.status_level < StatusReturnLevel.PING_AND_READ:
                return
            yield servo, address, length

    def _read_chain(self, items: Items) -> list[Reply]:
        return [
            Reply(_gap_ns(servo), encode_status(servo.id, *servo.read(address, length)))
            for servo, address, length in self._readers(items)
        ]

    def _read_fast(self, items: Items) -> list[Reply]:
        out, crc = _fast_head(items)
        parts, gap_ns = [out], -1
        for servo, address, length in self._readers(items if out else ()):
            if not servo.registers.firmware.fast_reads:
                break
            if gap_ns < 0:
                gap_ns = _gap_ns(servo)
            error, data = servo.read(address, length)
            if len(data) < length:
                data = data.ljust(length, b"\0")
            block, crc = fast_status_block(crc, error, servo.id, data)
            parts.append(block)
        return [Reply(gap_ns, b"".join(parts))] if gap_ns >= 0 else []

    def _write_sync(self, params: bytes) -> list[Reply]:
        if len(params) < _WORDS.size:
            return []
        address, length = _WORDS.unpack_from(params)
        for begin in range(_WORDS.size, len(params) - length, 1 + length):
            self._write_one(params[begin], address, params[begin + 1 : begin + 1 + length])
        return []

    def _write_bulk(self, params: bytes) -> list[Reply]:
        begin = 0
        while begin + _ITEM.size <= len(params):
            servo_id, address, length = _ITEM.unpack_from(params, begin)
            begin += _ITEM.size
            self._write_one(servo_id, address, params[begin : begin + length])
            begin += length
        return []

    def _write_one(self, servo_id: int, address: int, data: bytes) -> None:
        """One part of a group write, to a servo or to those whose secondary id it is."""
        servo = self._hearing.get(servo_id)
        for target in self._shadows(servo_id) if servo is None else (servo,):
            target.write(address, data)
            if address < EEPROM_END:
                self._keep_busy(target)


@lru_cache(maxsize=64)
def _sync_items(params: bytes) -> Items:
    """Servos of a sync read: the same block of each."""
    if len(params) < _WORDS.size:
        return ()
    address, length = _WORDS.unpack_from(params)
    return tuple((servo_id, address, length) for servo_id in params[_WORDS.size :])


@lru_cache(maxsize=64)
def _bulk_items(params: bytes) -> Items:
    """Servos of a bulk read: a block of its own for each."""
    whole = len(params) - len(params) % _ITEM.size
    return tuple(_ITEM.iter_unpack(params[:whole]))


@lru_cache(maxsize=64)
def _fast_head(items: Items) -> tuple[bytes, int]:
    """Start of a fast answer and its CRC; empty when the answer would not fit a packet."""
    if sum(item[2] for item in items) > TABLE_SIZE:
        return b"", 0
    head = fast_status_start([item[2] for item in items])
    return head, crc16(head)


def _collided(first: list[Reply], second: list[Reply]) -> list[Reply]:
    """Two servos of one id answer at once: a bit is 1 where both, or nobody, send 1."""
    replies = []
    for one, other in zip(first, second, strict=False):
        size = max(len(one.data), len(other.data))
        pairs = zip(one.data.ljust(size, _IDLE), other.data.ljust(size, _IDLE), strict=True)
        replies.append(one._replace(data=bytes(a & b for a, b in pairs)))
    return replies + max(first, second, key=len)[len(replies) :]


def _gap_ns(servo: EmulatedServo) -> int:
    return TURNAROUND_NS + servo.return_delay * RETURN_DELAY_UNIT_NS
