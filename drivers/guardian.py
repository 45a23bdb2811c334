"""A second process that switches torque off when the first one is gone, or hangs.

The servos' own watchdog stops them 40 ms after the last packet, but leaves them stiff. The
guardian knows sooner: it holds the other end of a pipe that the kernel closes with the controller,
whatever killed it. One that lives but does nothing any more is killed. The guardian shares the
open ports, and never touches them while the controller lives.
"""

import mmap
import os
import select
import signal
import struct
from collections.abc import Callable

HANG_S = 2.0
"""A controller that does not beat for so long hangs. The servos have stopped long before; a
program that the system held up for a second may still sit the robot down."""
LOOKS = 8
"""Looks at the beat in that time."""
_BEAT = struct.Struct("q")
_DONE = b"q"
_IGNORED = (
    signal.SIGINT,
    signal.SIGTERM,
    signal.SIGHUP,
    signal.SIGQUIT,
    signal.SIGTSTP,
    signal.SIGPIPE,
)
"""Stop signals are the controller's to answer: the guardian outlives it."""


class Guardian:
    """Watches over its maker from `start` to `close`; acts if the maker ends in between.

    It is a fork: what it does then uses the objects of the maker as they were at the start. It
    leaves the maker's process group, so that a Ctrl-C of the terminal does not reach it.
    """

    def __init__(self, off: Callable[[], object], hang_s: float = HANG_S) -> None:
        """`off` is called in the guardian's own process, once, after the maker has ended."""
        self._off = off
        self._look_s = hang_s / LOOKS
        self._beats = 0
        self._shared = mmap.mmap(-1, _BEAT.size)
        self._child: int | None = None
        self._pipe = -1

    def start(self) -> None:
        """Begin to watch. Does nothing if it watches already."""
        if self._child is not None:
            return
        reading, writing = os.pipe()
        maker = os.getpid()
        # A signal between the fork and the child's own answer to it would end the child; here it
        # would make the maker forget that it has one.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, _IGNORED)
        child = os.fork()
        if child == 0:
            try:
                os.close(writing)
                self._watch(reading, maker, mask)
            finally:
                os._exit(0)  # no clean-up of the maker's: it is the maker's
        os.close(reading)
        self._child, self._pipe = child, writing
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    def beat(self) -> None:
        """The maker lives: to be called more often than every `hang_s` while it watches."""
        self._beats += 1
        _BEAT.pack_into(self._shared, 0, self._beats)

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

    def take_over(self) -> None:
        """The maker has tried in vain and closes its ports: the guardian's turn."""
        if self.alive():
            self._forget()

    def _forget(self) -> None:
        os.close(self._pipe)
        self._child, self._pipe = None, -1

    def _watch(self, reading: int, maker: int, mask: set[int | signal.Signals]) -> None:
        os.setsid()
        for number in _IGNORED:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if self._hangs(reading):
            os.kill(maker, signal.SIGKILL)
            select.select([reading], [], [])  # it is gone: nobody else writes to the ports
        if os.read(reading, 1) != _DONE:
            self._off()

    def _hangs(self, reading: int) -> bool:
        """Wait for the maker's end or its word; True when it beats no more."""
        seen, still = self._shared[:], 0
        while not select.select([reading], [], [], self._look_s)[0]:
            beat = self._shared[:]
            seen, still = beat, still + 1 if beat == seen else 0
            if still >= LOOKS:
                return True
        return False
