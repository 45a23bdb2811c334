"""The firmware's frames: an encoder in C that knows only docs/frames.md checks our reader."""

import ctypes
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drivers.boards.frames import FootFrame, FrameReader
from sim_backends.virtual.boards import LoadCells

FRAMES_PAGE = Path(__file__).parents[3] / "docs" / "frames.md"

COUNT = st.integers(-(2**31), 2**31 - 1)
FRAME = st.builds(
    FootFrame,
    st.integers(0, 0xFFFF),
    st.integers(0, 2**32 - 1),
    st.integers(0, 0xFFFF),
    st.tuples(COUNT, COUNT, COUNT, COUNT),
)


def encode(firmware, frame):
    buffer = ctypes.create_string_buffer(30)
    counts = (ctypes.c_int32 * 4)(*frame.counts)
    firmware.foot_frame_encode(buffer, frame.sequence, frame.device_time_us, frame.status, counts)
    return buffer.raw


def test_the_crc_has_its_published_check_value(firmware):
    assert firmware.crc16_ccitt_false(b"123456789", 9) == 0x29B1


def test_the_documented_example(firmware):
    example = FRAMES_PAGE.read_text(encoding="utf-8").split("```")[1]
    assert encode(firmware, FootFrame(7, 1000, 15, (1, -2, 3, -4))) == bytes.fromhex(example)


@given(frames=st.lists(FRAME, max_size=5), garbage=st.binary(max_size=20))
def test_the_reader_recovers_what_the_firmware_sent(firmware, frames, garbage):
    # A sync byte would have the reader wait for the rest of what looks like a frame.
    stream = garbage.replace(b"\xa5", b"") + b"".join(encode(firmware, frame) for frame in frames)
    reader = FrameReader()
    assert reader.feed(stream) == frames
    assert reader.crc_errors == 0


@given(st.lists(st.floats(-100, 500), min_size=8, max_size=8), st.integers(0, 0xFFFF))
def test_the_virtual_board_sends_the_firmware_s_bytes(firmware, forces, sequence):
    plant = SimpleNamespace(corner_forces=lambda: forces)
    errors = SimpleNamespace(measure=lambda force: force, zero=0.0)
    for foot in (0, 1):
        virtual = LoadCells(plant, foot, errors, np.random.default_rng(3))
        sent = virtual.frame(sequence, 2**32 - 1 - sequence)
        (frame,) = FrameReader().feed(sent)
        assert encode(firmware, frame) == sent
