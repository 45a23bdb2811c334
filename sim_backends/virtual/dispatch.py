"""Instruction packets to servos, and their answers in the order of the wire."""

import struct
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from drivers.dynamixel.control_table import RETURN_DELAY_UNIT_NS, TABLE_SIZE, StatusReturnLevel
from drivers.dynamixel.protocol import (
    BROADCAST_ID,
    Instruction,
    Packet,
    StatusError,
    crc16,
    encode_status,
    fast_status_block,
    fast_status_start,
)
from sim_backends.virtual.servo import EmulatedServo

TURNAROUND_NS = 20_000
"""From the end of a packet to the answer of a servo with Return Delay Time 0 (assumed)."""
_KEPT = {b"\xff": (False, False), b"\x01": (True, False), b"\x02": (True, True)}
"""Parameter of FACTORY_RESET: whether id and baud are kept."""
_WORDS = struct.Struct("<HH")
_ITEM = struct.Struct("<BHH")

Items = tuple[tuple[int, int, int], ...]
"""Id, address and length for every servo of a group read."""


class Reply(NamedTuple):
    """What one servo sends."""

    gap_ns: int
    """Silence before it [ns]."""
    data: bytes


class Dispatcher:
    """Protocol 2.0 instructions (ROBOTIS e-manual) for the servos of one wire.

    Group reads are answered in the order of the request; where one servo does not answer, those
    behind it stay silent too (ROBOTIS in DynamixelSDK issue 364). A fast read is one packet that
    the servos write together, so it ends at that place; one for more bytes than fit a packet is
    not answered (assumed). Group writes are not answered at all.
    """

    def __init__(self, servos: Sequence[EmulatedServo]) -> None:
        self._servos = tuple(servos)
        self._hearing: dict[int, EmulatedServo] = {}
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
        self._hearing = {
            servo.id: servo
            for servo in self._servos
            if servo.baud_code == baud_code and servo.ready_ns <= now_ns
        }
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
            Reply(_gap_ns(servo), encode_status(servo.id, servo.error(), servo.identity()))
            for servo in servos
        ]

    def _tell_all(self, packet: Packet) -> list[Reply]:
        """An instruction to everybody, which nobody answers."""
        action = _SINGLE.get(packet.instruction)
        for servo in self._hearing.values():
            if action is not None:
                action(servo, packet.params)
        return []

    def _ask(self, packet: Packet) -> list[Reply]:
        """An instruction to one servo."""
        servo = self._hearing.get(packet.id)
        if servo is None or packet.instruction == Instruction.STATUS:
            return []
        gap_ns, level = _gap_ns(servo), servo.status_level
        action = _SINGLE.get(packet.instruction, _refuse)
        error, data = action(servo, packet.params)
        wanted = StatusReturnLevel.ALL
        if packet.instruction == Instruction.READ:
            wanted = StatusReturnLevel.PING_AND_READ
        if level < wanted:
            return []
        return [Reply(gap_ns, encode_status(packet.id, error, data))]

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
            servo = self._hearing.get(params[begin])
            if servo is not None:
                servo.write(address, params[begin + 1 : begin + 1 + length])
        return []

    def _write_bulk(self, params: bytes) -> list[Reply]:
        begin = 0
        while begin + _ITEM.size <= len(params):
            servo_id, address, length = _ITEM.unpack_from(params, begin)
            begin += _ITEM.size
            servo = self._hearing.get(servo_id)
            if servo is not None:
                servo.write(address, params[begin : begin + length])
            begin += length
        return []


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


def _gap_ns(servo: EmulatedServo) -> int:
    return TURNAROUND_NS + servo.return_delay * RETURN_DELAY_UNIT_NS


Answer = tuple[int, bytes]


def _refuse(servo: EmulatedServo, _: bytes) -> Answer:
    return servo.error(StatusError.INSTRUCTION), b""


def _read(servo: EmulatedServo, params: bytes) -> Answer:
    if len(params) != _WORDS.size:
        return servo.error(StatusError.DATA_LENGTH), b""
    return servo.read(*_WORDS.unpack(params))


def _write(servo: EmulatedServo, params: bytes) -> Answer:
    return servo.write(int.from_bytes(params[:2], "little"), params[2:]), b""


def _register_write(servo: EmulatedServo, params: bytes) -> Answer:
    return servo.register_write(int.from_bytes(params[:2], "little"), params[2:]), b""


def _act(servo: EmulatedServo, _: bytes) -> Answer:
    return servo.act(), b""


def _reboot(servo: EmulatedServo, _: bytes) -> Answer:
    servo.reboot()
    return servo.error(), b""


def _factory_reset(servo: EmulatedServo, params: bytes) -> Answer:
    if params not in _KEPT:
        return servo.error(StatusError.DATA_RANGE), b""
    servo.factory_reset(*_KEPT[params])
    return servo.error(), b""


def _clear(servo: EmulatedServo, params: bytes) -> Answer:
    return servo.clear(params), b""


_SINGLE: dict[int, Callable[[EmulatedServo, bytes], Answer]] = {
    Instruction.READ: _read,
    Instruction.WRITE: _write,
    Instruction.REG_WRITE: _register_write,
    Instruction.ACTION: _act,
    Instruction.REBOOT: _reboot,
    Instruction.FACTORY_RESET: _factory_reset,
    Instruction.CLEAR: _clear,
}
