"""Servo clocks against the host's: drift, wrap, late and repeated samples, restarts."""

import numpy as np
import pytest

from drivers.dynamixel.realtime_ticks import RealtimeTicks, Verdict

PERIOD_NS = 3_333_333
ALL = slice(0, 3)


def tick_at(time_ns, drift=0.0, start_ms=32_000):
    return int(start_ms + time_ns * (1 + drift) / 1e6) % 32768


@pytest.mark.parametrize("drift", [-0.01, 0.0, 0.01])
def test_drift_jitter_and_the_wrap_go_unnoticed(drift):
    rng = np.random.default_rng(1)
    clocks = RealtimeTicks(3)
    for place in range(3):
        assert clocks.judge(place, tick_at(0), 0) == (Verdict.FRESH, 0)
    for k in range(1, 20_000):  # 67 s: two wraps of the register
        time_ns = k * PERIOD_NS
        tick = tick_at(time_ns + int(rng.uniform(-4e5, 4e5)), drift)
        assert clocks.all_fresh(ALL, np.full(3, tick, dtype=np.uint16), time_ns)


def started():
    clocks = RealtimeTicks(1)
    for k in range(20):
        clocks.judge(0, tick_at(k * PERIOD_NS), k * PERIOD_NS)
    return clocks, 20 * PERIOD_NS


def test_an_older_sample_is_dated_and_a_repeated_one_is_not_taken():
    clocks, now_ns = started()
    late = tick_at(now_ns)
    verdict, age_ns = clocks.judge(0, late, now_ns + PERIOD_NS)
    assert verdict is Verdict.LATE
    assert age_ns == pytest.approx(PERIOD_NS, abs=1e6)
    assert clocks.judge(0, late, now_ns + 2 * PERIOD_NS)[0] is Verdict.REPEATED
    assert clocks.judge(0, late, now_ns + 10**9)[0] is Verdict.REPEATED
    assert clocks.judge(0, tick_at(now_ns + 10**9), now_ns + 10**9) == (Verdict.FRESH, 0)


@pytest.mark.parametrize("uptime_ms", [0, 20, 5_000, 30_000])
def test_a_clock_that_begins_anew_is_a_restart_once(uptime_ms):
    clocks, now_ns = started()
    assert clocks.judge(0, uptime_ms, now_ns)[0] is Verdict.RESTARTED
    assert clocks.judge(0, uptime_ms + 3, now_ns + PERIOD_NS)[0] is Verdict.FRESH


def test_after_forgetting_any_clock_is_right():
    clocks, now_ns = started()
    clocks.forget()
    assert clocks.judge(0, 7, now_ns)[0] is Verdict.FRESH
