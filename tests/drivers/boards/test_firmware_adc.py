"""The firmware's ADC driver and cell check on an ADC that answers as the data sheet says."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from drivers.boards.frames import FrameReader
from tests.drivers.boards.conftest import Board
from tests.drivers.boards.fake_adc import CLOCK, GAIN1, MODE, RESYNC_FLAG, STATUS

OK, NO_ANSWER, REGISTER_LOST = range(3)
ALL = 0b1111
FULL_SCALE = 2**23 - 1
SETTLING = 3
RECOVERY = 50
COUNT = st.integers(-8_000_000, 8_000_000)


def decode(frame):
    (decoded,) = FrameReader().feed(frame)
    return decoded


def noise(number, offset=1000):
    """Counts that differ from sample to sample, as those of real cells do."""
    return [offset + 37 * number % 1009 + cell for cell in range(4)]


def feed(board, number, first=0):
    return [decode(board.sample(noise(first + i))) for i in range(number)]


@pytest.fixture
def running(board):
    """A board whose four cells are believed."""
    assert board.start() == OK
    assert feed(board, SETTLING + RECOVERY)[-1].status == ALL
    return board


def test_start_sets_rate_gain_and_word_length(board):
    assert board.start() == OK
    adc = board.adc
    assert adc.data_rate >= 600
    assert adc.gains == [64] * 4
    assert adc.registers[CLOCK] >> 8 == 0x0F
    assert adc.registers[CLOCK] & 3 == 2
    assert adc.registers[MODE] == 0x0110
    assert not adc.registers[STATUS] & 0x0400


@pytest.mark.parametrize("register", [MODE, CLOCK, GAIN1])
def test_start_sees_a_register_that_does_not_keep_its_value(board, register):
    board.adc.forgets = register
    assert board.start() == REGISTER_LOST


def test_start_sees_a_silent_adc_a_bad_wire_and_another_chip(board):
    board.adc.silent = True
    assert board.start() == NO_ANSWER
    board.adc.silent = False
    board.adc.flip = {1: 1}
    assert board.start() == NO_ANSWER
    board.adc.flip = {}
    board.adc.channels = 2
    assert board.start() == NO_ANSWER
    board.adc.channels = 4
    board.adc.power_up()
    assert board.start() == OK


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
@given(st.lists(st.tuples(COUNT, COUNT, COUNT, COUNT), min_size=1, max_size=5))
def test_counts_keep_their_sign_and_every_bit(firmware, samples):
    board = Board(firmware)
    board.start()
    for counts in [*samples, (0, -1, 2**23 - 1, -(2**23))]:
        assert decode(board.sample(counts)).counts == counts


def test_the_filter_settles_before_a_cell_is_believed(board):
    board.start()
    statuses = [frame.status for frame in feed(board, SETTLING + RECOVERY)]
    assert statuses == [0] * (SETTLING + RECOVERY - 1) + [ALL]


def test_frames_count_up_and_carry_the_time_of_the_sample(running):
    running.time_us = 2**32 - 1500
    frames = feed(running, 4)
    assert np.diff([frame.sequence for frame in frames]).tolist() == [1, 1, 1]
    # The filter's delay, 750 µs, before DRDY; the second DRDY comes after the clock has wrapped.
    expected = [2**32 - 1250, 2**32 - 250, 750, 1750]
    assert [frame.device_time_us for frame in frames] == expected


@pytest.mark.parametrize("place", range(17))
def test_a_frame_that_the_wire_damaged_is_believed_in_no_cell(running, place):
    running.adc.flip = {place: 0x10}
    assert decode(running.sample(noise(100))).status == 0
    running.adc.flip = {}
    assert decode(running.sample(noise(101))).status == ALL


def test_after_a_missed_drdy_the_newest_conversion_is_sent(running):
    running.adc.convert([9, 9, 9, 9])
    frame = decode(running.sample([5, 6, 7, 8], periods=2))
    assert frame.counts == (5, 6, 7, 8)
    assert frame.status == ALL
    assert decode(running.sample([6, 7, 8, 9])).counts == (6, 7, 8, 9)


def test_an_old_conversion_is_not_believed_twice(running):
    last = feed(running, 1)[0]
    running.time_us += 1000
    again = decode(running.answer())
    assert again.counts == last.counts
    assert again.status == 0


def test_a_channel_without_a_new_conversion_is_not_believed(running):
    running.adc.new_channels = 0b1011
    assert decode(running.sample(noise(200))).status == 0b1011


@pytest.mark.parametrize("cleared_by_reading", [0, RESYNC_FLAG])
def test_a_resynchronised_filter_settles_first(running, cleared_by_reading):
    running.adc.cleared_by_reading = cleared_by_reading
    running.adc.registers[STATUS] |= RESYNC_FLAG
    statuses = [frame.status for frame in feed(running, SETTLING + 1)]
    assert statuses == [0] * SETTLING + [ALL]


def test_an_adc_that_reset_itself_is_noticed_and_started_again(running):
    running.adc.power_up()
    running.answer()  # The answer that was pending, as after any command.
    before = decode(running.sample(noise(1)))
    assert before.status == 0
    assert running.is_lost
    assert running.start() == OK
    assert not running.is_lost
    frames = feed(running, SETTLING + RECOVERY)
    assert frames[-1].status == ALL
    assert frames[0].sequence == before.sequence + 1


def test_an_adc_that_speaks_nonsense_is_started_again(running):
    running.adc.silent = True
    for number in range(10):
        assert not running.is_lost
        assert decode(running.sample(noise(number))).status == 0
    assert running.is_lost


@pytest.mark.parametrize("clipped", [FULL_SCALE, -FULL_SCALE - 1, 8_300_000])
def test_an_open_cell_is_out_of_range_and_alone_in_that(running, clipped):
    counts = noise(300)
    counts[2] = clipped
    assert decode(running.sample(counts)).status == 0b1011
    statuses = [frame.status for frame in feed(running, RECOVERY, first=301)]
    assert statuses == [0b1011] * (RECOVERY - 1) + [ALL]


def test_a_count_that_stays_the_same_is_a_stuck_cell(running):
    statuses = []
    for number in range(10):
        counts = noise(number, offset=5000)
        counts[0] = 77
        statuses.append(decode(running.sample(counts)).status)
    assert statuses == [ALL] * 7 + [0b1110] * 3
