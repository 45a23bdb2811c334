"""Samples dated by the servos' own clocks: late, repeated, or from a servo that began anew."""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from drivers.dynamixel.control_table import REALTIME_TICK_MODULUS
from hil.interface import Ints

TICK_NS = 1_000_000
"""Realtime Tick counts milliseconds (e-manual, address 120)."""
TOLERANCE_MS = 2
"""Disagreement of servo and host that means nothing: rounding of both, and jitter of the host."""
RESTART_MS = 100
"""Disagreement that no late answer explains: the servo counts from zero again."""
FOLLOW_EVERY = 2
"""Calls between steps of half a millisecond by which a servo's clock is followed: a drift of up to
7.5 % at 300 Hz, 1.5 % at 60 Hz; more than its oscillator has (assumed)."""
_HALF = 2
"""The register wraps at 2¹⁵. Counted in half milliseconds it wraps as 16-bit arithmetic does."""
_LIMIT = _HALF * TOLERANCE_MS
_NEVER = -1

Index = slice | Ints
Ticks = NDArray[np.uint16]


class Verdict(Enum):
    """What a servo's clock says of its sample."""

    FRESH = "of this tick"
    LATE = "older than it should be"
    REPEATED = "not newer than the last one"
    RESTARTED = "the clock began anew"


class RealtimeTicks:
    """The clocks of n servos against the host's.

    A servo's clock runs ahead of the host's by an offset that is constant but for drift. Of a
    sample at host time t with tick c, d = c - t - offset is 0 but for jitter; d < 0 is its age
    beyond what the host thought. All three are kept in half milliseconds modulo 2¹⁶.
    """

    def __init__(self, n: int) -> None:
        self._offset = np.zeros(n, dtype=np.uint16)
        self._last = np.full(n, _NEVER, dtype=np.int64)
        self._known = False
        """Every servo was judged once."""
        self._calls = 0

    def all_fresh(self, index: Index, ticks: Ticks, sample_ns: int) -> bool:
        """Whether all of these samples are of this tick, and nothing else is to be said."""
        if not self._known:
            return False
        # One more than allowed below zero wraps to a large number: one comparison for both ends.
        raised = ticks * _HALF - self._offset[index] - (_host(sample_ns) - _LIMIT & 0xFFFF)
        if max(raised.tolist()) > 2 * _LIMIT:
            return False
        self._last[index] = ticks
        self._calls += 1
        if self._calls % FOLLOW_EVERY == 0:
            self._offset[index] += np.sign(raised.view(np.int16) - _LIMIT).view(np.uint16)
        return True

    def judge(self, place: int, tick: int, sample_ns: int) -> tuple[Verdict, int]:
        """One servo's sample: the verdict, and its age beyond what the host thought [ns]."""
        last = int(self._last[place])
        raw = _HALF * tick - _host(sample_ns)
        offset = int(self._offset[place])
        deviation = (raw - offset + 2**15) % 2**16 - 2**15
        if tick == last and deviation < -_LIMIT:
            return Verdict.REPEATED, 0
        if last == _NEVER or abs(deviation) > _HALF * RESTART_MS:
            self._offset[place] = raw % 2**16
            self._last[place] = tick
            self._known = bool((self._last != _NEVER).all())
            return (Verdict.FRESH if last == _NEVER else Verdict.RESTARTED), 0
        if -deviation > _LIMIT and not _is_newer(tick, last):
            return Verdict.REPEATED, 0
        self._last[place] = tick
        self._calls += 1
        if self._calls % FOLLOW_EVERY == 0:
            self._offset[place] = (offset + max(-1, min(1, deviation))) % 2**16
        if -deviation > _LIMIT:
            return Verdict.LATE, -deviation * TICK_NS // _HALF
        return Verdict.FRESH, 0

    def forget(self) -> None:
        """Begin anew with whatever the servos say next (after a pause of unknown length)."""
        self._last[:] = _NEVER
        self._known = False


def _is_newer(tick: int, last: int) -> bool:
    return 0 < (tick - last) % REALTIME_TICK_MODULUS < REALTIME_TICK_MODULUS // 2


def _host(time_ns: int) -> int:
    """Host time in half milliseconds, modulo 2¹⁶."""
    return time_ns * _HALF // TICK_NS & 0xFFFF
