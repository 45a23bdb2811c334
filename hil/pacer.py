"""Holds a lockstep run back to the clock on the wall, so that a person can follow and steer it."""

from hil.timing import pause, stopwatch_ns

LOST_NS = 250_000_000
"""A run that is so far behind is not made to catch up: it goes on from where it is."""


class Pacer:
    """Virtual time changes nothing by waiting: the run's numbers are those of a run without it."""

    def __init__(self) -> None:
        self._offset_ns: int | None = None

    def wait(self, time_ns: int) -> None:
        """Return when as much wall time has passed as clock time since the first call."""
        now_ns = stopwatch_ns()
        if self._offset_ns is None or now_ns - time_ns - self._offset_ns > LOST_NS:
            self._offset_ns = now_ns - time_ns
        ahead_ns = time_ns + self._offset_ns - now_ns
        if ahead_ns > 0:
            pause(ahead_ns * 1e-9)
