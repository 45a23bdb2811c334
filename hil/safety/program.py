"""The program itself: ticks that come too late, commands that are clamped too often."""

import numpy as np

from hil.interface import Limit
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

MAX_PAUSE_NS = 40_000_000
"""The bus watchdog's time (2 units of 20 ms): after it the servos have stopped by themselves."""
WINDOW_TICKS, MAX_CLAMPED = 100, 25
"""Ticks of a window, and how many of them may have been clamped before it is told."""
_CLAMPED = int(Limit.POSITION | Limit.VELOCITY | Limit.TORQUE)


class PauseMonitor:
    """Time between two ticks: the computer slept, or the process was stopped."""

    def __init__(self) -> None:
        self._last_ns: int | None = None

    def look(self, situation: Situation) -> list[Event]:
        """SOFT_STOP after a pause in which the servos were left alone too long."""
        last_ns, self._last_ns = self._last_ns, situation.now_ns
        if last_ns is None or situation.now_ns - last_ns <= MAX_PAUSE_NS:
            return []
        pause_ms = (situation.now_ns - last_ns) // 1_000_000
        return [Event("program", f"paused {pause_ms} ms", Severity.SOFT_STOP)]


class ClampMonitor:
    """How many of the last WINDOW_TICKS had a command outside the joints' limits."""

    def __init__(self) -> None:
        self._clamped = np.zeros(WINDOW_TICKS, dtype=np.bool_)
        self._count, self._row = 0, 0

    def look(self, situation: Situation) -> list[Event]:
        """WARN when it is more than MAX_CLAMPED."""
        clamped = bool(np.bitwise_or.reduce(situation.applied.limit) & _CLAMPED)
        if clamped or self._count:
            self._count += clamped - bool(self._clamped[self._row])
            self._clamped[self._row] = clamped
            self._row = (self._row + 1) % WINDOW_TICKS
        if self._count > MAX_CLAMPED:
            return [Event("program", "commands outside limits", Severity.WARN)]
        return []
