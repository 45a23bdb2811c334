"""The reduced build for an ATmega328P, run instruction by instruction in simavr on a pty."""

import time

import numpy as np
import pytest

from drivers.boards.frames import FrameReader
from drivers.dynamixel.port import Port

STEPS = np.array([1237, 4099, 20011, 65537])
PERIOD_US = 5000
OPEN = 64
RECOVERY = 50
FRAMES = 160


def counts_of(sequence):
    """What foot_avr.c makes up."""
    counts = (sequence * STEPS & 0x3FFFFF) - 0x200000
    if sequence & OPEN:
        counts[3] = 2**23 - 1
    return tuple(counts.tolist())


def status_of(sequence):
    """The last cell is open for 64 of 128 frames, and believed 50 good samples later."""
    good = sequence % (2 * OPEN) + 1
    last = not sequence & OPEN and good >= RECOVERY
    others = sequence + 1 >= RECOVERY
    return 0b0111 * others | last << 3


@pytest.mark.pty
def test_the_avr_s_bytes_are_frames_for_our_port_and_reader(avr_pty):
    port = Port("left_foot", avr_pty, 500_000)
    reader = FrameReader()
    frames = []
    end = time.monotonic() + 20
    while len(frames) < FRAMES and time.monotonic() < end:
        frames += reader.feed(port.read_available())
        time.sleep(0.01)
    port.close()
    assert len(frames) >= FRAMES
    assert reader.crc_errors == 0
    assert reader.lost_frames == 0
    for frame in frames:
        assert frame.counts == counts_of(frame.sequence)
        assert frame.status == status_of(frame.sequence)
        assert frame.device_time_us == (frame.sequence + 1) * PERIOD_US
