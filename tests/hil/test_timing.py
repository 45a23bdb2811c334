import gc

import pytest

from hil.clock import ManualClock
from hil.errors import InputError
from hil.timing import TickSchedule, quiet_garbage_collector, real_time_priority

PERIOD_NS = 1_000_000_000 // 250


def run_ticks(schedule, clock, durations_ns):
    """Tick numbers and start times for ticks that last as given."""
    ticks = []
    for duration_ns in durations_ns:
        ticks.append((schedule.wait(), clock.now_ns()))
        clock.sleep_until_ns(clock.now_ns() + duration_ns)
        schedule.finish()
    return ticks


def test_ticks_come_on_the_absolute_grid_whatever_they_last():
    clock = ManualClock(123)
    schedule = TickSchedule(clock, 300)
    ticks = run_ticks(schedule, clock, [1_000_000, 3_000_000, 2_000_000, 0])
    assert ticks == [(k, 123 + k * 1_000_000_000 // 300) for k in range(4)]
    assert (schedule.missed, schedule.skipped) == (0, 0)


def test_a_million_ticks_do_not_drift():
    schedule = TickSchedule(ManualClock(), 300)
    assert schedule.time_ns(3_000_000) == 10_000 * 1_000_000_000


def test_a_long_tick_skips_what_it_missed_and_never_bursts():
    clock = ManualClock()
    schedule = TickSchedule(clock, 250)
    ticks = run_ticks(schedule, clock, [0, int(3.7 * PERIOD_NS), 0, 0])
    assert [tick for tick, _ in ticks] == [0, 1, 5, 6]
    assert ticks[2][1] == 5 * PERIOD_NS
    assert schedule.skipped == 3
    assert schedule.missed == 4  # the long one and the three that never ran


def test_a_slightly_late_tick_is_followed_at_once_by_the_one_that_is_due():
    clock = ManualClock()
    schedule = TickSchedule(clock, 250)
    ticks = run_ticks(schedule, clock, [int(1.2 * PERIOD_NS), 0, 0])
    assert ticks == [(0, 0), (1, int(1.2 * PERIOD_NS)), (2, 2 * PERIOD_NS)]
    assert schedule.late_ns == 0
    assert (schedule.skipped, schedule.missed) == (0, 1)


def test_ticks_before_the_first_walking_one_are_negative():
    clock = ManualClock(1_000)
    schedule = TickSchedule(clock, 250, first_tick=-2)
    ticks = run_ticks(schedule, clock, [0, 0, 0])
    assert ticks == [(-2, 1_000), (-1, 1_000 + PERIOD_NS), (0, 1_000 + 2 * PERIOD_NS)]


def test_nothing_is_collected_inside_and_everything_is_as_before_after():
    with quiet_garbage_collector():
        assert not gc.isenabled()
        assert gc.get_freeze_count() > 0
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


def test_the_collector_comes_back_after_an_exception():
    with pytest.raises(RuntimeError), quiet_garbage_collector():
        raise RuntimeError
    assert gc.isenabled()


def test_a_priority_that_is_not_permitted_is_one_clear_error(monkeypatch):
    def refuse(*arguments):
        raise PermissionError

    monkeypatch.setattr("os.sched_setscheduler", refuse)
    with pytest.raises(InputError, match=r"--priority 50.*ulimit -r 50"), real_time_priority(50):
        pass
