"""Frames that the foot and IMU boards send: bytes to raw values and back (docs/frames.md).

Everything is little-endian: `A5 5A · kind · payload length · sequence u16 · device time u32 [µs] ·
payload · CRC u16`. The kind's high nibble is the protocol version, its low nibble the board. The
CRC is CRC-16/CCITT-FALSE over everything between the two sync bytes and itself.
"""

import struct
from binascii import crc_hqx
from collections.abc import Sequence
from enum import IntFlag
from typing import NamedTuple

import numpy as np

SYNC = b"\xa5\x5a"
VERSION = 1
KIND_FOOT = VERSION << 4 | 1
KIND_IMU = VERSION << 4 | 2
OVERHEAD = 12
"""Bytes of a frame beside its payload."""
DEVICE_TIME_MODULUS = 1 << 32
"""Device time wraps after 2³² µs, 71.6 minutes."""
SEQUENCE_MODULUS = 1 << 16
LARGEST_GAP = 1000
"""Frames that can be lost in a row and still count as lost: more than a second's worth."""

STANDARD_GRAVITY = 9.80665
ORIENTATION_UNIT = 1 / 16384
"""Quaternion component of one count (Q14)."""
GYRO_UNIT = np.deg2rad(2000) / 32768
"""[rad/s] of one count: ±2000 °/s full scale."""
ACCELERATION_UNIT = 8 * STANDARD_GRAVITY / 32768
"""[m/s²] of one count: ±8 g full scale."""

_FOOT = struct.Struct("<2xBBHIH4i")
_IMU = struct.Struct("<2xBBHIH4h3h3h")
_CRC = struct.Struct("<H")
_PAYLOAD_SIZE = {KIND_FOOT: _FOOT.size - 10, KIND_IMU: _IMU.size - 10}
FRAME_SIZE = {kind: size + OVERHEAD for kind, size in _PAYLOAD_SIZE.items()}
"""Bytes of a whole frame of each kind."""
_CRC_START = 0xFFFF

ALL_CELLS = 0b1111
CELL_RAIL = (1 << 23) - 1
"""Counts of a cell at the end of its 24-bit converter's range: open, shorted or overloaded."""
"""Status of a foot frame whose four cells are valid."""


class ImuStatus(IntFlag):
    """Status bits of an IMU frame: which parts are valid."""

    NONE = 0
    ORIENTATION = 1
    GYRO = 2
    ACCELEROMETER = 4
    ALL = 7


class FootFrame(NamedTuple):
    """Raw load-cell counts of one foot."""

    sequence: int
    device_time_us: int
    status: int
    """Bit i: cell i is valid, corners in interface order."""
    counts: tuple[int, int, int, int]
    """Corners in interface order."""


class ImuFrame(NamedTuple):
    """Raw IMU registers, in the board's axes."""

    sequence: int
    device_time_us: int
    status: int
    """`ImuStatus` bits."""
    orientation: tuple[int, int, int, int]
    """Board to world (w, x, y, z) [ORIENTATION_UNIT]."""
    gyro: tuple[int, int, int]
    """[GYRO_UNIT]"""
    acceleration: tuple[int, int, int]
    """Specific force [ACCELERATION_UNIT]."""


Frame = FootFrame | ImuFrame


def encode_foot_frame(
    sequence: int, device_time_us: int, status: int, counts: Sequence[int]
) -> bytes:
    """A foot frame; sequence and device time are taken modulo their widths."""
    size = _PAYLOAD_SIZE[KIND_FOOT]
    head = sequence % SEQUENCE_MODULUS, device_time_us % DEVICE_TIME_MODULUS
    return _seal(_FOOT.pack(KIND_FOOT, size, *head, status, *counts))


def encode_imu_frame(
    sequence: int,
    device_time_us: int,
    status: int,
    orientation: Sequence[int],
    gyro: Sequence[int],
    acceleration: Sequence[int],
) -> bytes:
    """An IMU frame of raw counts; sequence and device time are taken modulo their widths."""
    size = _PAYLOAD_SIZE[KIND_IMU]
    head = sequence % SEQUENCE_MODULUS, device_time_us % DEVICE_TIME_MODULUS
    return _seal(_IMU.pack(KIND_IMU, size, *head, status, *orientation, *gyro, *acceleration))


def _seal(frame: bytes) -> bytes:
    body = frame[2:]
    return SYNC + body + _CRC.pack(crc_hqx(body, _CRC_START))


class FrameReader:
    """Bytes in any portions to frames; garbage is skipped and counted, nothing raises."""

    def __init__(self) -> None:
        self._buffer = b""
        self._last_sequence: int | None = None
        self.crc_errors = 0
        """Frames with a wrong CRC."""
        self.skipped_bytes = 0
        """Bytes that belong to no valid frame."""
        self.lost_frames = 0
        """Gaps in the sequence numbers."""

    def feed(self, data: bytes) -> list[Frame]:
        """Take what was received; return the frames that are complete now, oldest first."""
        buffer = self._buffer + data
        position = 0
        frames: list[Frame] = []
        end = len(buffer)
        while end - position >= OVERHEAD:
            if not buffer.startswith(SYNC, position):
                position = self._resync(buffer, position)
                continue
            kind = buffer[position + 2]
            size = _PAYLOAD_SIZE.get(kind)
            if size is None or size != buffer[position + 3]:
                position = self._resync(buffer, position + 1, 1)
                continue
            stop = position + size + OVERHEAD
            if stop > end:
                break
            if crc_hqx(buffer[position + 2 : stop - 2], _CRC_START) == (
                buffer[stop - 2] | buffer[stop - 1] << 8
            ):
                frames.append(self._decode(kind, buffer, position))
                position = stop
            else:
                self.crc_errors += 1
                position = self._resync(buffer, position + 1, 1)
        self._buffer = buffer[position:]
        return frames

    def _resync(self, buffer: bytes, position: int, skipped: int = 0) -> int:
        """Position of the next sync bytes, or of the last byte if that may begin them."""
        found = buffer.find(SYNC, position)
        if found < 0:
            found = len(buffer) - buffer.endswith(SYNC[:1])
        self.skipped_bytes += skipped + found - position
        return found

    def _decode(self, kind: int, buffer: bytes, position: int) -> Frame:
        layout = _FOOT if kind == KIND_FOOT else _IMU
        _, _, sequence, time_us, status, *rest = layout.unpack_from(buffer, position)
        self._count_lost(sequence)
        if kind == KIND_FOOT:
            return FootFrame(sequence, time_us, status, (rest[0], rest[1], rest[2], rest[3]))
        w, x, y, z, *vectors = rest
        gyro = (vectors[0], vectors[1], vectors[2])
        acceleration = (vectors[3], vectors[4], vectors[5])
        return ImuFrame(sequence, time_us, status, (w, x, y, z), gyro, acceleration)

    def _count_lost(self, sequence: int) -> None:
        """A gap beyond LARGEST_GAP is a restart of the board, not a loss."""
        if self._last_sequence is not None:
            gap = (sequence - self._last_sequence - 1) % SEQUENCE_MODULUS
            if gap <= LARGEST_GAP:
                self.lost_frames += gap
        self._last_sequence = sequence
