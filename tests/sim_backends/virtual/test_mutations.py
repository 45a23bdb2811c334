"""Damaged bytes: nothing raises, and what is accepted has a CRC that fits."""

import importlib.util
from pathlib import Path
from random import Random

from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.boards.frames import FrameReader, encode_foot_frame
from drivers.dynamixel.protocol import Packet, PacketReader, decode_fast_status

ROOT = Path(__file__).resolve().parents[3]
_SPEC = importlib.util.spec_from_file_location("fuzz", ROOT / "benchmarks" / "fuzz_frames.py")
fuzz = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(fuzz)


def test_a_small_run_of_the_fuzzer_finds_nothing_unexplained():
    verdicts = fuzz.run(3000, seed=1)
    assert verdicts.unexplained == []
    assert sum(n for what, n in verdicts.count.items() if what.endswith("frames")) >= 3000


class TrustsEverything(PacketReader):
    """Takes whatever comes for a packet."""

    def feed(self, data):
        return [Packet(1, 3, bytes(data))]


def test_the_fuzzer_notices_a_reader_that_does_not_check(monkeypatch):
    monkeypatch.setattr(fuzz, "PacketReader", TrustsEverything)
    verdicts = fuzz.Verdicts()
    fuzz.fuzz_servos(50, Random(0), verdicts)
    assert len(verdicts.unexplained) > 10


def test_the_second_crc_is_the_published_one():
    ping = bytes.fromhex("FFFFFD00 01 0300 01")
    assert fuzz.crc16_bitwise(ping) == 0x4E19


@given(st.data())
@settings(max_examples=200, deadline=None)
def test_any_damage_in_any_portions_is_digested(data):
    random = Random(data.draw(st.integers(0, 2**32)))
    frame, other = random.sample(fuzz.instructions(random), 2)
    stream = fuzz.Mutator(random).damage(frame, other)
    cut = data.draw(st.integers(0, len(stream)))
    reader = PacketReader()
    packets = reader.feed(stream[:cut]) + reader.feed(stream[cut:])
    sent = [p for f in (frame, other) for p in PacketReader().feed(f)]
    assert all(p in sent or fuzz.vouched(stream, p.params) for p in packets)
    decode_fast_status(stream, [10] * 6)
    servos = fuzz.Servos()
    servos.answer(stream)


@given(st.binary(max_size=200), st.integers(0, 200))
@settings(max_examples=200, deadline=None)
def test_a_board_reader_survives_noise_and_finds_the_frame_behind_it(noise, cut):
    frame = encode_foot_frame(1, 2, 15, (3, 4, 5, 6))
    reader = FrameReader()
    stream = noise + bytes(40) + frame
    got = reader.feed(stream[:cut]) + reader.feed(stream[cut:])
    assert got[-1].counts == (3, 4, 5, 6)
