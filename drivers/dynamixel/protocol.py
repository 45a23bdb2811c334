"""Dynamixel Protocol 2.0: packets to bytes and back, for both ends of the wire.

A packet is `FF FF FD 00 · ID · LEN (2) · instruction · parameters · CRC (2)`, little-endian, where
LEN counts everything after itself. Inside instruction and parameters every `FF FF FD` is followed
by a stuffed `FD`, which LEN and the CRC (poly 0x8005, start 0, not reflected) include. A status
packet has instruction 0x55 and the error byte as its first parameter.

A fast read is answered by one status packet from ID 0xFE that the servos write together, not
stuffed: after the header `error, id, data, CRC` for each servo, each CRC running over every byte
since the first header byte, earlier CRCs included. So LEN = 1 + Σ(4 + data bytes), and every block
that arrived can be trusted even when a later servo is silent.

Source: ROBOTIS e-manual, DYNAMIXEL Protocol 2.0.
"""

from collections.abc import Iterable, Sequence
from enum import IntEnum
from typing import NamedTuple

from fastcrc.crc16 import umts

HEADER = b"\xff\xff\xfd\x00"
BROADCAST_ID = 0xFE
MAX_ID = 252
ALERT = 0x80
"""Bit of the error byte: Hardware Error Status is not zero."""
ERROR_MASK = 0x7F
PREFIX_SIZE = 7
"""Bytes of a packet that LEN does not count."""
MAX_LENGTH = 1024
"""Largest LEN taken for a packet; a larger one is noise."""
FAST_BLOCK_OVERHEAD = 4
"""Bytes of a fast block beside its data: error, id, CRC."""

_PATTERN = b"\xff\xff\xfd"
_STUFFED = b"\xff\xff\xfd\xfd"


class Instruction(IntEnum):
    """Instruction byte of a packet."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    BACKUP = 0x20
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class StatusError(IntEnum):
    """Low seven bits of a status packet's error byte."""

    NONE = 0
    RESULT_FAIL = 1
    INSTRUCTION = 2
    CRC = 3
    DATA_RANGE = 4
    DATA_LENGTH = 5
    DATA_LIMIT = 6
    ACCESS = 7


class Packet(NamedTuple):
    """One packet with a valid CRC, unstuffed (but for a fast status, which never is stuffed)."""

    id: int
    instruction: int
    params: bytes
    """Parameters; of a status packet the first is the error byte."""

    @property
    def is_status(self) -> bool:
        """A servo sent it."""
        return self.instruction == Instruction.STATUS

    @property
    def is_fast_status(self) -> bool:
        """Servos wrote it together, in answer to a fast read."""
        return self.instruction == Instruction.STATUS and self.id == BROADCAST_ID

    @property
    def error(self) -> int:
        """Error byte of a status packet, 0 if it has none."""
        return self.params[0] if self.params else 0

    @property
    def data(self) -> bytes:
        """What follows the error byte of a status packet."""
        return self.params[1:]


class FastBlock(NamedTuple):
    """One servo's part of the answer to a fast read."""

    error: int
    id: int
    data: bytes


def crc16(data: bytes, crc: int = 0) -> int:
    """CRC of Protocol 2.0, continued from `crc`."""
    return int(umts(data, crc))


def stuff(data: bytes) -> bytes:
    """Insert an FD after every FF FF FD."""
    return data.replace(_PATTERN, _STUFFED)


def unstuff(data: bytes) -> bytes:
    """Exact inverse of `stuff`."""
    return data.replace(_STUFFED, _PATTERN)


def encode_instruction(servo_id: int, instruction: int, params: bytes = b"") -> bytes:
    """An instruction packet."""
    body = stuff(bytes((instruction,)) + params)
    packet = HEADER + bytes((servo_id,)) + (len(body) + 2).to_bytes(2, "little") + body
    return packet + crc16(packet).to_bytes(2, "little")


def encode_status(servo_id: int, error: int, params: bytes = b"") -> bytes:
    """A status packet; params is what follows the error byte."""
    return encode_instruction(servo_id, Instruction.STATUS, bytes((error,)) + params)


def encode_read(servo_id: int, address: int, length: int) -> bytes:
    """Read a block of one servo."""
    params = address.to_bytes(2, "little") + length.to_bytes(2, "little")
    return encode_instruction(servo_id, Instruction.READ, params)


def encode_write(servo_id: int, address: int, data: bytes) -> bytes:
    """Write a block of one servo."""
    return encode_instruction(servo_id, Instruction.WRITE, address.to_bytes(2, "little") + data)


def encode_sync_read(ids: Iterable[int], address: int, length: int, fast: bool = False) -> bytes:
    """Read the same block of several servos."""
    params = address.to_bytes(2, "little") + length.to_bytes(2, "little") + bytes(ids)
    instruction = Instruction.FAST_SYNC_READ if fast else Instruction.SYNC_READ
    return encode_instruction(BROADCAST_ID, instruction, params)


def encode_bulk_read(items: Iterable[tuple[int, int, int]], fast: bool = False) -> bytes:
    """Read a block of its own from each servo; items are (id, address, length)."""
    params = b"".join(
        bytes((servo_id,)) + address.to_bytes(2, "little") + length.to_bytes(2, "little")
        for servo_id, address, length in items
    )
    instruction = Instruction.FAST_BULK_READ if fast else Instruction.BULK_READ
    return encode_instruction(BROADCAST_ID, instruction, params)


def encode_sync_write(address: int, length: int, items: Iterable[tuple[int, bytes]]) -> bytes:
    """Write the same block of several servos; items are (id, data of `length` bytes)."""
    params = address.to_bytes(2, "little") + length.to_bytes(2, "little")
    params += b"".join(bytes((servo_id,)) + data for servo_id, data in items)
    return encode_instruction(BROADCAST_ID, Instruction.SYNC_WRITE, params)


def fast_status_start(data_lengths: Sequence[int]) -> bytes:
    """What the first servo of a fast read sends before its own block."""
    length = 1 + sum(FAST_BLOCK_OVERHEAD + size for size in data_lengths)
    return HEADER + bytes((BROADCAST_ID, length & 0xFF, length >> 8, Instruction.STATUS))


def fast_status_block(crc: int, error: int, servo_id: int, data: bytes) -> tuple[bytes, int]:
    """One servo's block after everything with running CRC `crc`; and the CRC behind it."""
    body = bytes((error, servo_id)) + data
    crc = crc16(body, crc)
    own = crc.to_bytes(2, "little")
    return body + own, crc16(own, crc)


def encode_fast_status(blocks: Sequence[FastBlock]) -> bytes:
    """The answer to a fast read of servos that are all present."""
    out = fast_status_start([len(block.data) for block in blocks])
    crc = crc16(out)
    for block in blocks:
        part, crc = fast_status_block(crc, *block)
        out += part
    return out


def decode_fast_status(data: bytes, data_lengths: Sequence[int]) -> list[FastBlock]:
    """Blocks of a fast answer, up to the first that is missing or damaged.

    `data` starts at the header and may end anywhere; `data_lengths` are those asked for, in order.
    """
    position = PREFIX_SIZE + 1
    blocks: list[FastBlock] = []
    if data[:position] != fast_status_start(data_lengths):
        return blocks
    crc = crc16(data[:position])
    for size in data_lengths:
        end = position + 2 + size
        block = data[position : end + 2]
        own = crc16(block[:-2], crc)
        if len(block) < size + FAST_BLOCK_OVERHEAD or own.to_bytes(2, "little") != block[-2:]:
            break
        blocks.append(FastBlock(block[0], block[1], block[2:-2]))
        crc = crc16(block[-2:], own)
        position = end + 2
    return blocks


class PacketReader:
    """Bytes in any portions to packets; garbage is skipped and counted, nothing raises.

    A packet whose CRC is wrong gives up its first byte only, so that a packet behind a false
    header is still found. Work is bounded by LEN ≤ MAX_LENGTH for every header seen.
    """

    def __init__(self) -> None:
        self._buffer = bytearray()
        self.crc_errors = 0
        """Packets with a wrong CRC."""
        self.skipped_bytes = 0
        """Bytes that belong to no valid packet."""

    @property
    def pending(self) -> bytes:
        """What is received of a packet that is not complete."""
        return bytes(self._buffer)

    def reset(self) -> None:
        """Forget an unfinished packet."""
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()

    def feed(self, data: bytes) -> list[Packet]:
        """Take what was received; return the packets that are complete now."""
        if not self._buffer and _is_whole(data):
            return [_decoded(data)]
        self._buffer += data
        packets: list[Packet] = []
        while self._seek_header():
            size = self._packet_size()
            if size == 0:
                self._skip(1)
            elif len(self._buffer) < size:
                break
            else:
                self._take(size, packets)
        return packets

    def _seek_header(self) -> bool:
        """Drop bytes before a header; whether the prefix of a packet is there."""
        start = self._buffer.find(HEADER)
        if start < 0:
            kept = next((n for n in (3, 2, 1) if self._buffer.endswith(HEADER[:n])), 0)
            self._skip(len(self._buffer) - kept)
            return False
        self._skip(start)
        return len(self._buffer) >= PREFIX_SIZE

    def _packet_size(self) -> int:
        """Whole size of the packet at the start of the buffer, 0 if there cannot be one."""
        length = self._buffer[5] | self._buffer[6] << 8
        return length + PREFIX_SIZE if 3 <= length <= MAX_LENGTH else 0

    def _take(self, size: int, packets: list[Packet]) -> None:
        raw = bytes(self._buffer[:size])
        if crc16(raw[:-2]) != raw[-2] | raw[-1] << 8:
            self.crc_errors += 1
            self._skip(1)
            return
        del self._buffer[:size]
        packets.append(_decoded(raw))

    def _skip(self, count: int) -> None:
        self.skipped_bytes += count
        del self._buffer[:count]


def _is_whole(data: bytes) -> bool:
    """Whether this is one sound packet and nothing else."""
    length = len(data) - PREFIX_SIZE
    begins = length >= 3 and data.startswith(HEADER) and data[5] | data[6] << 8 == length
    return begins and length <= MAX_LENGTH and crc16(data[:-2]) == data[-2] | data[-1] << 8


def _decoded(raw: bytes) -> Packet:
    """A whole packet; the answer to a fast read is not stuffed."""
    body = raw[PREFIX_SIZE:-2]
    if not (raw[4] == BROADCAST_ID and body[0] == Instruction.STATUS):
        body = unstuff(body)
    return Packet(raw[4], body[0], body[1:])
