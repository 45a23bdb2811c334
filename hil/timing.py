"""Tick schedule, deadline accounting, and the process made quiet enough to keep deadlines.

The only module that may look at the wall clock (`stopwatch_ns`), and only to measure the cost of
a tick for the report: no decision of a run depends on it.
"""

import gc
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from hil.clock import tick_time_ns
from hil.errors import InputError
from hil.interface import Clock

stopwatch_ns = time.perf_counter_ns
"""Wall time for measuring durations [ns]."""

pause = time.sleep
"""Wait in wall time [s], for a process outside the tick."""


@dataclass(slots=True)
class TickTiming:
    """What one tick cost, in wall time."""

    tick: int = 0
    """Negative during start-up, 0 at the first walking tick."""
    late_ns: int = 0
    """Clock time at which the tick began, after its schedule."""
    read_ns: int = 0
    estimate_ns: int = 0
    safety_ns: int = 0
    """The supervisor's judgement."""
    control_ns: int = 0
    """The controller's step alone."""
    write_ns: int = 0
    """Limits and write."""
    truth_ns: int = 0
    """Asking a simulated world for the truth."""
    cycle_ns: int = 0
    """From the wake-up to the hand-over to the recorder, and the hand-over of the tick before."""


class TickSchedule:
    """Tick k at `start + k*10**9 // rate` on an injected clock; never re-armed from "now".

    A tick that ends late is followed at once by the newest tick that is due, if less than half a
    period has passed since it was; older ones are skipped, so that ticks never come in a burst.
    """

    def __init__(self, clock: Clock, rate_hz: int, first_tick: int = 0) -> None:
        self._clock = clock
        self._rate_hz = rate_hz
        self.next_tick = first_tick
        self._start_ns = clock.now_ns() - first_tick * 1_000_000_000 // rate_hz
        self.tick = first_tick - 1
        self.late_ns = 0
        self.skipped = 0
        self.missed = 0
        """Ticks that were skipped, or ended after the next one was due."""

    def time_ns(self, tick: int) -> int:
        """Clock time at which a tick is due."""
        return tick_time_ns(self._start_ns, tick, self._rate_hz)

    def wait(self) -> int:
        """Sleep until the next tick and return its number."""
        due_ns = self.time_ns(self.next_tick)
        self._clock.sleep_until_ns(due_ns)
        self.tick = self.next_tick
        self.late_ns = self._clock.now_ns() - due_ns
        return self.tick

    def finish(self) -> None:
        """Account for the tick that has just ended, and choose the next one."""
        now_ns = self._clock.now_ns()
        self.next_tick = self.tick + 1
        if now_ns <= self.time_ns(self.next_tick):
            return
        half_period_ns = 500_000_000 // self._rate_hz
        while self.time_ns(self.next_tick) + half_period_ns <= now_ns:
            self.next_tick += 1
        skipped = self.next_tick - self.tick - 1
        self.skipped += skipped
        self.missed += skipped + 1


@contextmanager
def quiet_garbage_collector() -> Iterator[None]:
    """Collect now and not again until the block ends, so that no tick pays for a collection."""
    enabled = gc.isenabled()
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.unfreeze()
        if enabled:
            gc.enable()


@contextmanager
def real_time_priority(priority: int | None) -> Iterator[None]:
    """SCHED_FIFO for the block, if a priority is given. Raises InputError if not permitted."""
    if priority is None:
        yield
        return
    policy, parameter = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError as error:
        raise InputError(
            f"--priority {priority}: this user may not use real-time priorities; allow it with "
            f"`ulimit -r {priority}` (limits.conf: rtprio) or leave the option out"
        ) from error
    try:
        yield
    finally:
        os.sched_setscheduler(0, policy, parameter)
