"""Ticks fall on an absolute grid, and clocks do not run backwards."""

import os
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.clock import ManualClock, MonotonicClock, substeps_per_tick, tick_time_ns


@given(st.integers(0, 10**7), st.sampled_from([225, 250, 275, 300]))
def test_ticks_never_drift(tick, rate):
    exact = tick * 1e9 / rate
    assert abs(tick_time_ns(5, tick, rate) - 5 - exact) <= 1.0 + exact * 1e-15


@pytest.mark.parametrize(("rate", "substeps"), [(300, 4), (225, 5), (250, 5), (1200, 1), (60, 19)])
def test_substeps_reach_the_minimum_frequency_and_no_more(rate, substeps):
    assert substeps_per_tick(rate) == substeps
    assert substeps * rate >= 1100 > (substeps - 1) * rate


def test_manual_clock_moves_only_forward():
    clock = ManualClock(100)
    clock.sleep_until_ns(50)
    assert clock.now_ns() == 100
    clock.sleep_until_ns(150)
    assert clock.now_ns() == 150


class Pipe:
    """A byte stream of the kernel, as a serial port is."""

    def __init__(self):
        self.reader, self.writer = os.pipe()

    in_waiting = 0

    def fileno(self):
        return self.reader


def test_monotonic_clock_wakes_for_bytes_and_at_the_deadline():
    clock, pipe = MonotonicClock(), Pipe()
    before = time.monotonic_ns()
    clock.wait_readable([pipe], before + 5_000_000)
    assert time.monotonic_ns() - before >= 5_000_000
    os.write(pipe.writer, b"x")
    far = time.monotonic_ns() + 60_000_000_000
    clock.wait_readable([pipe], far)
    assert time.monotonic_ns() < far
