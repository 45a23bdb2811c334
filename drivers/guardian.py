"""A second process that switches torque off when the first one is gone.

The servos' own watchdog stops them 40 ms after the last packet, but leaves them stiff. The
guardian knows sooner: it holds the other end of a pipe that the kernel closes with the controller,
whatever killed it. It shares the open ports, and never touches them while the controller lives.
"""

import os
import select
import signal
from collections.abc import Callable

_DONE = b"q"
_IGNORED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE)
"""Stop signals are the controller's to answer: the guardian outlives it."""


class Guardian:
    """Watches over its maker from `start` to `close`; acts if the maker ends in between.

    It is a fork: what it does then uses the objects of the maker as they were at the start. It
    leaves the maker's process group, so that a Ctrl-C of the terminal does not reach it.
    """

    def __init__(self, off: Callable[[], object]) -> None:
        """`off` is called in the guardian's own process, once, after the maker has ended."""
        self._off = off
        self._child: int | None = None
        self._pipe = -1

    def start(self) -> None:
        """Begin to watch. Does nothing if it watches already."""
        if self._child is not None:
            return
        reading, writing = os.pipe()
        # A signal between the fork and the child's own answer to it would end the child.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, _IGNORED)
        child = os.fork()
        if child == 0:
            try:
                os.close(writing)
                self._watch(reading, mask)
            finally:
                os._exit(0)  # no clean-up of the maker's: it is the maker's
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        os.close(reading)
        self._child, self._pipe = child, writing

    def alive(self) -> bool:
        """Whether it watches: started, and not ended by somebody else."""
        if self._child is None:
            return False
        ended, _ = os.waitpid(self._child, os.WNOHANG)
        if ended:
            self._forget()
        return self._child is not None

    def close(self) -> None:
        """Send it home: torque is off. Safe to call twice, and when it has died."""
        if not self.alive() or self._child is None:
            return
        child = self._child
        os.write(self._pipe, _DONE)
        self._forget()
        os.waitpid(child, 0)

    def _forget(self) -> None:
        os.close(self._pipe)
        self._child, self._pipe = None, -1

    def _watch(self, reading: int, mask: set[int | signal.Signals]) -> None:
        os.setsid()
        for number in _IGNORED:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        select.select([reading], [], [])
        if os.read(reading, 1) != _DONE:
            self._off()
