"""Stop signals, taken at a point where the loop can act on them.

The first signal waits for the end of the tick, so that no packet is cut in two. A second one
does not wait: it raises at once, for a controller that hangs. While the robot is being stopped,
signals are counted and wait.
"""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class StopSignals:
    """Signals received since `caught` began."""

    def __init__(self) -> None:
        self._received: list[int] = []
        self._shielded = False

    def first(self) -> str | None:
        """Name of the first signal received, or none."""
        return signal.Signals(self._received[0]).name if self._received else None

    def check(self) -> None:
        """Raise KeyboardInterrupt for SIGINT, SystemExit(128 + number) for another signal."""
        if self._received:
            _raise(self._received[0])

    @contextmanager
    def caught(self) -> Iterator[None]:
        """Handle stop signals here for the block; outside the main thread there are none."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        previous = {number: signal.signal(number, self._handle) for number in STOP_SIGNALS}
        try:
            yield
        finally:
            for number, handler in previous.items():
                signal.signal(number, handler)

    @contextmanager
    def shielded(self) -> Iterator[None]:
        """Let nothing interrupt the block: torque is going off in it."""
        self._shielded = True
        try:
            yield
        finally:
            self._shielded = False

    def _handle(self, number: int, frame: FrameType | None) -> None:
        del frame  # The tick's end is the place to act, wherever this came.
        self._received.append(number)
        if len(self._received) > 1 and not self._shielded:
            _raise(number)


def _raise(number: int) -> None:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise SystemExit(128 + number)
