"""The run's end of the live view: ticks into shared memory, facts and words over a socket."""

import contextlib
import json
import os
import select
import socket
import subprocess
from collections.abc import Callable
from typing import Any

import numpy as np

from hil.child_process import spawn
from hil.cycle import TickRecord
from hil.errors import BackendError, InputError
from hil.interface import Ints
from hil.record_layout import WORD, tick_dtype
from hil.recorder_ring import Ring

START_TIMEOUT_S = 20.0
END_TIMEOUT_S = 3.0
MESSAGE = 1 << 16
READY, FAILED = "ready ", "failed "
"""How the view's first message begins."""

Facts = Callable[[], dict[str, Any]]


class ViewFeed:
    """A sink for one view. It never waits: a full ring or a dead view costs a tick nothing.

    The tick's row is the recorder's, copied word by word; facts that no tick holds (statistics of
    the bus, the supervisor's reasons) follow once a second as JSON on a socket pair, without
    blocking. On the same pair the view sends what is steered, a line a message.
    """

    def __init__(self, job: dict[str, Any], rate_hz: int) -> None:
        """Starts the view. Raises InputError if it cannot be shown here."""
        dtype = tick_dtype(job["joints"], truth=job["truth"])
        self._ring = Ring.create(dtype)
        self._words = np.frombuffer(self._ring.rows, np.int64).reshape(
            self._ring.slots, dtype.itemsize // WORD
        )
        self._last_row: Callable[[], Ints] | None = None
        self._every = rate_hz
        self._ticks = 0
        self.facts: Facts = dict
        """Asked for once a second."""
        self.socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        descriptors = [self._ring.descriptor, theirs.fileno()]
        job |= {"ring": descriptors[0], "socket": descriptors[1], "parent": os.getpid()}
        with theirs:
            self._process = spawn("hil.view.process", job, descriptors)
        try:
            self.place = self._await_ready()
        except BaseException:
            self.close()
            raise

    def follow(self, last_row: Callable[[], Ints]) -> None:
        """Show what the recorder records from now on."""
        self._last_row = last_row

    def put(self, record: TickRecord) -> None:
        """Copy the tick that the recorder has just put."""
        del record  # Its row is packed already.
        ring = self._ring
        if self._last_row is not None and not ring.full:
            self._words[ring.next_row] = self._last_row()
            ring.publish()
        self._ticks += 1
        if self._ticks == self._every:
            self._ticks = 0
            self._tell()

    def close(self) -> None:
        """Tell the view that the run is over, and see that it ends."""
        self._tell()
        self._ring.finish()
        try:
            self._process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self.socket.close()
        os.close(self._ring.descriptor)

    def _tell(self) -> None:
        with contextlib.suppress(OSError):  # its queue is full, or it has died
            self.socket.send(json.dumps(self.facts()).encode(), socket.MSG_DONTWAIT)

    def _await_ready(self) -> str:
        """Where the view is, in its own words. Raises InputError or BackendError."""
        if not select.select([self.socket], [], [], START_TIMEOUT_S)[0]:
            raise BackendError(f"--view: it did not come up in {START_TIMEOUT_S:.0f} s")
        message = self.socket.recv(MESSAGE).decode()
        if message.startswith(READY):
            return message.removeprefix(READY)
        reason = message.removeprefix(FAILED) or "its process died; its message is above"
        raise InputError(f"--view: {reason}")
