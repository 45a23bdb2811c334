"""The codec against the e-manual's published packets, against the SDK, and on anything at all."""

import itertools

import pytest
from dynamixel_sdk import Protocol2PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from drivers.dynamixel import protocol
from drivers.dynamixel.protocol import FastBlock, Instruction, PacketReader


def packet(text):
    return bytes.fromhex(text)


# ROBOTIS e-manual, DYNAMIXEL Protocol 2.0, the examples of each instruction.
PUBLISHED_INSTRUCTIONS = {
    "ping id 1": (1, 0x01, "", "FFFFFD00 01 0300 01 194E"),
    "ping all": (0xFE, 0x01, "", "FFFFFD00 FE 0300 01 3142"),
    "read": (1, 0x02, "84000400", "FFFFFD00 01 0700 02 84000400 1D15"),
    "write": (1, 0x03, "740000020000", "FFFFFD00 01 0900 03 740000020000 CA89"),
    "reg write": (1, 0x04, "6800C8000000", "FFFFFD00 01 0900 04 6800C8000000 AE8E"),
    "action": (1, 0x05, "", "FFFFFD00 01 0300 05 02CE"),
    "factory reset": (1, 0x06, "01", "FFFFFD00 01 0400 06 01 A1E6"),
    "reboot": (1, 0x08, "", "FFFFFD00 01 0300 08 2F4E"),
    "clear": (1, 0x10, "0144584C22", "FFFFFD00 01 0800 10 0144584C22 B1DC"),
    "sync read": (0xFE, 0x82, "840004000102", "FFFFFD00 FE 0900 82 840004000102 CEFA"),
    "sync write": (
        0xFE, 0x83, "74000400 0196000000 02AA000000",
        "FFFFFD00 FE 1100 83 74000400 0196000000 02AA000000 8287",
    ),
    "bulk read": (
        0xFE, 0x92, "0190000200 0292000100",
        "FFFFFD00 FE 0D00 92 0190000200 0292000100 1A05",
    ),
    "bulk write": (
        0xFE, 0x93, "0120000200A000 021F00010050",
        "FFFFFD00 FE 1000 93 0120000200A000 021F00010050 B768",
    ),
    "fast sync read": (
        0xFE, 0x8A, "84000400030704", "FFFFFD00 FE 0A00 8A 84000400030704 20F2",
    ),
}  # fmt: skip
PUBLISHED_STATUS = {
    "ping": (1, 0, "060426", "FFFFFD00 01 0700 55 00 060426 655D"),
    "ping id 2": (2, 0, "060426", "FFFFFD00 02 0700 55 00 060426 6F6D"),
    "read": (1, 0, "A6000000", "FFFFFD00 01 0800 55 00 A6000000 8CC0"),
    "sync read id 2": (2, 0, "1F080000", "FFFFFD00 02 0800 55 00 1F080000 BABE"),
    "write": (1, 0, "", "FFFFFD00 01 0400 55 00 A10C"),
    "voltage": (1, 0, "7700", "FFFFFD00 01 0600 55 00 7700 C369"),
    "temperature": (2, 0, "24", "FFFFFD00 02 0500 55 00 24 8BA9"),
}
FAST_SYNC_ANSWER = packet(
    "FFFFFD00 FE 1900 55 00 03 A6000000 8408 00 07 1F080000 16CA 00 04 FF030000 D19E"
)
FAST_BULK_ANSWER = packet("FFFFFD00 FE 1400 55 00 03 A6000000 67A4 00 07 A501 2474 00 04 1F D9C1")


@pytest.mark.parametrize("name", PUBLISHED_INSTRUCTIONS)
def test_instruction_packets_are_as_published(name):
    servo_id, instruction, params, expected = PUBLISHED_INSTRUCTIONS[name]
    assert protocol.encode_instruction(servo_id, instruction, packet(params)) == packet(expected)
    assert PacketReader().feed(packet(expected)) == [(servo_id, instruction, packet(params))]


@pytest.mark.parametrize("name", PUBLISHED_STATUS)
def test_status_packets_are_as_published(name):
    servo_id, error, data, expected = PUBLISHED_STATUS[name]
    assert protocol.encode_status(servo_id, error, packet(data)) == packet(expected)
    (received,) = PacketReader().feed(packet(expected))
    assert (received.id, received.error, received.data) == (servo_id, error, packet(data))


def test_the_named_encoders_make_the_published_packets():
    published = {name: packet(row[3]) for name, row in PUBLISHED_INSTRUCTIONS.items()}
    assert protocol.encode_read(1, 132, 4) == published["read"]
    assert protocol.encode_write(1, 116, packet("00020000")) == published["write"]
    assert protocol.encode_sync_read([1, 2], 132, 4) == published["sync read"]
    assert protocol.encode_sync_read([3, 7, 4], 132, 4, fast=True) == published["fast sync read"]
    assert protocol.encode_bulk_read([(1, 144, 2), (2, 146, 1)]) == published["bulk read"]
    goals = [(1, packet("96000000")), (2, packet("AA000000"))]
    assert protocol.encode_sync_write(116, 4, goals) == published["sync write"]


@pytest.mark.parametrize(
    ("answer", "lengths", "expected"),
    [
        (FAST_SYNC_ANSWER, [4, 4, 4], [(3, "A6000000"), (7, "1F080000"), (4, "FF030000")]),
        (FAST_BULK_ANSWER, [4, 2, 1], [(3, "A6000000"), (7, "A501"), (4, "1F")]),
    ],
    ids=["fast sync read", "fast bulk read"],
)
def test_fast_answers_are_as_published(answer, lengths, expected):
    blocks = [FastBlock(0, servo_id, packet(data)) for servo_id, data in expected]
    assert protocol.encode_fast_status(blocks) == answer
    assert protocol.decode_fast_status(answer, lengths) == blocks
    (received,) = PacketReader().feed(answer)
    assert received.is_fast_status


@pytest.mark.parametrize("cut", range(len(FAST_SYNC_ANSWER)))
def test_blocks_before_a_break_are_saved(cut):
    blocks = protocol.decode_fast_status(FAST_SYNC_ANSWER[:cut], [4, 4, 4])
    assert [block.id for block in blocks] == [3, 7, 4][: max(0, (cut - 8) // 8)]


@pytest.mark.parametrize("position", range(len(FAST_SYNC_ANSWER)))
def test_no_damaged_block_is_believed(position):
    good = protocol.decode_fast_status(FAST_SYNC_ANSWER, [4, 4, 4])
    for bit in range(8):
        damaged = bytearray(FAST_SYNC_ANSWER)
        damaged[position] ^= 1 << bit
        blocks = protocol.decode_fast_status(bytes(damaged), [4, 4, 4])
        assert blocks == good[: max(0, (position - 8) // 8)]


def test_stuffing_round_trips_for_every_pattern_up_to_six_bytes():
    for size in range(7):
        for symbols in itertools.product((0xFF, 0xFD, 0x00), repeat=size):
            data = bytes(symbols)
            stuffed = protocol.stuff(data)
            assert protocol.unstuff(stuffed) == data
            assert protocol.HEADER not in stuffed


@given(st.binary(max_size=40), st.integers(0, 252), st.integers(0, 255))
def test_status_packets_round_trip(data, servo_id, error):
    (received,) = PacketReader().feed(protocol.encode_status(servo_id, error, data))
    assert (received.id, received.error, received.data) == (servo_id, error, data)


@given(st.lists(st.sampled_from(b"\xff\xfd\x00\x55"), max_size=40).map(bytes))
def test_stuffed_packets_round_trip_and_equal_the_sdks_stuffing(params):
    ours = protocol.encode_instruction(1, Instruction.WRITE, params)
    body = [0xFF, 0xFF, 0xFD, 0, 1, *(len(params) + 3).to_bytes(2, "little"), 3, *params, 0, 0]
    theirs = Protocol2PacketHandler().addStuffing(list(body))
    assert list(ours[:-2]) == theirs[: len(ours) - 2]
    assert PacketReader().feed(ours) == [(1, Instruction.WRITE, params)]


@given(st.binary(max_size=200))
def test_the_crc_is_the_sdks(data):
    assert protocol.crc16(data) == Protocol2PacketHandler().updateCRC(0, data, len(data))


@given(st.binary(max_size=300), st.integers(1, 20))
def test_a_packet_behind_garbage_is_found_in_any_portions(garbage, portion):
    wanted = protocol.encode_status(7, 0, b"\x01\x02\x03\x04")
    # Enough to complete any packet that the garbage pretends to begin.
    stream = garbage + b"\x00" * (protocol.MAX_LENGTH + 10) + wanted
    reader = PacketReader()
    received = []
    for start in range(0, len(stream), portion):
        received += reader.feed(stream[start : start + portion])
    assert (7, Instruction.STATUS, b"\x00\x01\x02\x03\x04") in received


@given(st.lists(st.sampled_from([b"\xff", b"\xff\xff\xfd\x00", b"\xfd", b"\x03\x00", b"\x55"])))
def test_the_reader_never_raises_and_loses_no_byte_unnoticed(parts):
    reader = PacketReader()
    stream = b"".join(parts)
    packets = reader.feed(stream)
    kept = len(reader.pending)
    assert reader.skipped_bytes + kept + sum(10 + len(p.params) for p in packets) >= len(stream)
    reader.reset()
    assert reader.pending == b""


def test_a_wrong_crc_is_counted_and_the_next_packet_found():
    good = protocol.encode_status(1, 0, b"\x11")
    bad = good[:-1] + bytes((good[-1] ^ 1,))
    reader = PacketReader()
    assert len(reader.feed(bad + good)) == 1
    assert reader.crc_errors == 1
