"""Clocks: the monotonic one of real time and a manual one for tests.

The virtual robot has a clock of its own (`sim_backends.virtual`), on which physics is stepped.
"""

import select
import time
from collections.abc import Sequence

from hil.interface import Readable


class MonotonicClock:
    """Real time: never steps, whatever happens to the wall clock."""

    def now_ns(self) -> int:
        """Current time [ns]."""
        return time.monotonic_ns()

    def sleep_until_ns(self, time_ns: int) -> None:
        """Sleep to an absolute time; return at once if it is past."""
        while (remaining := time_ns - time.monotonic_ns()) > 0:
            time.sleep(remaining * 1e-9)

    def wait_readable(self, ports: Sequence[Readable], deadline_ns: int) -> None:
        """Block in select until a port has bytes or the deadline has come; never polls."""
        remaining = max(0, deadline_ns - time.monotonic_ns())
        select.select([port.fileno() for port in ports], [], [], remaining * 1e-9)


class ManualClock:
    """Time that moves only when it is told to, for tests."""

    def __init__(self, start_ns: int = 0) -> None:
        self._now_ns = start_ns

    def now_ns(self) -> int:
        """Current time [ns]."""
        return self._now_ns

    def sleep_until_ns(self, time_ns: int) -> None:
        """Jump to an absolute time; never backwards."""
        self._now_ns = max(self._now_ns, time_ns)

    def wait_readable(self, ports: Sequence[Readable], deadline_ns: int) -> None:
        """Jump to the deadline unless a port has bytes already."""
        if not any(port.in_waiting for port in ports):
            self.sleep_until_ns(deadline_ns)


def tick_time_ns(start_ns: int, tick: int, rate_hz: int) -> int:
    """Absolute time of a tick: `start + tick*10**9 // rate`, without accumulated rounding."""
    return start_ns + tick * 1_000_000_000 // rate_hz


def substeps_per_tick(rate_hz: int, minimum_hz: int = 1100) -> int:
    """Whole physics substeps a tick, the fewest that reach the minimum substep frequency."""
    return max(1, -(-minimum_hz // rate_hz))
