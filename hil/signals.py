"""Stops that the operator asks for, taken at a point where the loop can act on them.

| asked by | means |
|---|---|
| SIGINT (Ctrl-C), SIGTERM, SIGHUP (terminal closed), SIGTSTP (Ctrl-Z), key q, `stop --sit` | sit down, then torque off, at the end of the tick |
| SIGQUIT (Ctrl-\\), space, `stop`, or any second one | torque off now, wherever the program is |

The second kind is the software stop. It raises in the main thread at once, for a controller that
hangs too, and once only: nothing interrupts the way out that it begins. While the robot is being
stopped anyway, requests are noted and wait.
"""  # noqa: E501

import signal
import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType

SITTING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP)
"""A program that Ctrl-Z suspends would leave the servos to their watchdogs: it ends instead."""
STOP_NOW = signal.SIGQUIT
STOP_SIGNALS = (*SITTING_SIGNALS, STOP_NOW)
STOPPED = 1
"""Exit code of a run that a key or the socket stopped, as of any run that had to stop."""


class OperatorStop(BaseException):
    """The operator wants the run to end. No Exception: a controller must not catch it."""

    def __init__(self, name: str, exit_code: int) -> None:
        self.exit_code = exit_code
        super().__init__(name)


@dataclass(frozen=True, slots=True)
class StopRequest:
    """One wish to stop."""

    name: str
    """Of the signal or key, or `socket`."""
    now: bool
    """Torque off at once; otherwise sit down first."""
    number: int | None = None
    """Of the signal; none for a key or the socket."""

    def exception(self) -> BaseException:
        """What comes out of the run, and with it the program's exit code."""
        if self.number == signal.SIGINT:
            return KeyboardInterrupt()
        if self.number is None:
            return OperatorStop(self.name, STOPPED)
        if self.number == STOP_NOW:
            return OperatorStop(self.name, 128 + self.number)
        return SystemExit(128 + self.number)


class StopSignals:
    """Requests received since `caught` began."""

    def __init__(self) -> None:
        self._received: list[StopRequest] = []
        self._news: deque[StopRequest] = deque()
        self._posted: deque[StopRequest] = deque()
        self._shielded = self._caught = False

    def first(self) -> str | None:
        """Name of the first request received, or none."""
        return self._received[0].name if self._received else None

    def news(self) -> StopRequest | None:
        """A request that was not asked for yet, or none."""
        return self._news.popleft() if self._news else None

    def check(self) -> None:
        """Raise KeyboardInterrupt for SIGINT, SystemExit(128 + number) for another signal,
        OperatorStop for a software stop, a key or the socket."""
        if self._received:
            raise self._received[0].exception()

    def post(self, name: str, *, now: bool) -> None:
        """A request from another thread; one for now interrupts the main thread at once."""
        request = StopRequest(name, now)
        if now and self._caught:
            self._posted.append(request)
            signal.pthread_kill(threading.main_thread().ident or 0, STOP_NOW)
        else:
            self._take(request)

    @contextmanager
    def caught(self) -> Iterator[None]:
        """Handle stop signals here for the block; outside the main thread there are none."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        previous = {number: signal.signal(number, self._handle) for number in STOP_SIGNALS}
        self._caught = True
        try:
            yield
        finally:
            self._caught = False
            for number, handler in previous.items():
                signal.signal(number, handler)

    @contextmanager
    def shielded(self) -> Iterator[None]:
        """Let nothing interrupt the block: torque is going off in it."""
        before, self._shielded = self._shielded, True
        try:
            yield
        finally:
            self._shielded = before

    def _handle(self, number: int, frame: FrameType | None) -> None:
        del frame  # The tick's end is the place to act, wherever this came.
        if number == STOP_NOW and self._posted:
            request = self._posted.popleft()
        else:
            again = bool(self._received)
            now = again or number == STOP_NOW
            request = StopRequest(signal.Signals(number).name, now, number)
        self._take(request)
        if request.now and not self._shielded:
            self._shielded = True  # once: somebody who hammers on the keys must not end the end
            raise request.exception()

    def _take(self, request: StopRequest) -> None:
        self._received.append(request)
        self._news.append(request)
