"""Board frames: the documented bytes, resynchronisation, and counting what is lost."""

import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.boards import frames
from drivers.boards.frames import FootFrame, FrameReader, ImuFrame

FOOT = frames.encode_foot_frame(7, 1000, 15, (1, -2, 3, -4))
IMU = frames.encode_imu_frame(8, 2000, 7, (16384, 0, 0, 0), (1, 2, 3), (-4, 5, 4096))


def ccitt_false(data):
    """CRC-16/CCITT-FALSE bit by bit, from its definition (check value 0x29B1)."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def test_foot_frame_has_the_documented_bytes():
    assert ccitt_false(b"123456789") == 0x29B1
    body = b"\x11\x12" + struct.pack("<HIH4i", 7, 1000, 15, 1, -2, 3, -4)
    assert b"\xa5\x5a" + body + struct.pack("<H", ccitt_false(body)) == FOOT


def test_imu_frame_has_the_documented_bytes():
    body = b"\x12\x16" + struct.pack("<HIH10h", 8, 2000, 7, 16384, 0, 0, 0, 1, 2, 3, -4, 5, 4096)
    assert b"\xa5\x5a" + body + struct.pack("<H", ccitt_false(body)) == IMU


def test_the_documented_example_is_a_frame():
    page = (Path(__file__).parents[2] / "docs" / "frames.md").read_text(encoding="utf-8")
    example = page.split("```")[1]
    assert bytes.fromhex(example) == FOOT


def test_frames_round_trip():
    assert FrameReader().feed(FOOT + IMU) == [
        FootFrame(7, 1000, 15, (1, -2, 3, -4)),
        ImuFrame(8, 2000, 7, (16384, 0, 0, 0), (1, 2, 3), (-4, 5, 4096)),
    ]


@given(st.binary(max_size=60), st.integers(1, 35))
def test_a_frame_behind_garbage_is_found_in_any_portions(garbage, portion):
    reader = FrameReader()
    stream = garbage + FOOT + b"\0" * 40
    received = []
    for start in range(0, len(stream), portion):
        received += reader.feed(stream[start : start + portion])
    assert FootFrame(7, 1000, 15, (1, -2, 3, -4)) in received


@given(st.lists(st.sampled_from([b"\xa5", b"\x5a", b"\x11\x12", b"\x12\x16", b"\0" * 5, FOOT])))
def test_the_reader_never_raises_and_counts_every_skipped_byte(parts):
    reader = FrameReader()
    stream = b"".join(parts)
    received = reader.feed(stream)
    accounted = reader.skipped_bytes + sum(len(FOOT) for _ in received)
    assert 0 <= len(stream) - accounted < len(IMU) + 12


@pytest.mark.parametrize("position", range(2, len(FOOT)))
def test_no_damaged_frame_is_believed(position):
    for bit in range(8):
        damaged = bytearray(FOOT)
        damaged[position] ^= 1 << bit
        assert FrameReader().feed(bytes(damaged) + IMU) == FrameReader().feed(IMU)


def test_wrong_crcs_and_lost_sequence_numbers_are_counted():
    reader = FrameReader()
    reader.feed(FOOT[:-1] + bytes((FOOT[-1] ^ 1,)))
    assert reader.crc_errors == 1
    for sequence in (65533, 65534, 1, 2):
        reader.feed(frames.encode_foot_frame(sequence, 0, 15, (0, 0, 0, 0)))
    assert reader.lost_frames == 2  # 65535 and 0


def test_a_restarted_board_has_lost_nothing():
    reader = FrameReader()
    for sequence in (40000, 0, 1):
        reader.feed(frames.encode_foot_frame(sequence, 0, 15, (0, 0, 0, 0)))
    assert reader.lost_frames == 0
