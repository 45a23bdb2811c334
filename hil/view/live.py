"""What the view knows of the run: the newest tick, the last seconds' timing, the run's facts."""

import json
import os
import socket
from contextlib import suppress
from typing import Any

import numpy as np

from hil.interface import Ints
from hil.recorder_ring import Ring, Rows
from hil.steering.words import Word

MEMORY = 1500
"""Ticks whose timing is kept: 5 s at 300 Hz."""
MESSAGE = 1 << 16


class LiveRun:
    """Reads the ring and the socket of one run; never waits for either."""

    def __init__(self, ring: Ring, link: socket.socket, parent: int) -> None:
        """`parent`: process id of the run; when it is gone, so is the run."""
        self._ring, self._link, self._parent = ring, link, parent
        self.row: Any = np.zeros(1, ring.rows.dtype)[0]
        """The newest tick, as a record of `tick_dtype`."""
        self.ticks = 0
        """Ticks seen."""
        self.skipped = 0
        """Ticks that never ran, because one before them took too long."""
        self.facts: dict[str, Any] = {}
        self._cycle_ns = np.zeros(MEMORY, dtype=np.int64)
        self._late_ns = np.zeros(MEMORY, dtype=np.int64)
        self._last_tick: int | None = None

    @property
    def over(self) -> bool:
        """Whether the run has ended, or its process is gone."""
        return self._ring.finished or os.getppid() != self._parent

    def update(self) -> bool:
        """Take what has arrived; whether there was a tick."""
        pieces = self._ring.take()
        for piece in pieces:
            self._count(piece)
            self.row = piece[-1].copy()
            self._ring.release(len(piece))
        with suppress(BlockingIOError, ConnectionError):
            while message := self._link.recv(MESSAGE, socket.MSG_DONTWAIT):
                self.facts = json.loads(message)
        return bool(pieces)

    def say(self, word: Word) -> None:
        """Steer; lost if the run does not read."""
        self._send(word.line())

    def stop(self, word: str) -> None:
        """`off` or `sit`."""
        self._send(word)

    def cycle_ns(self) -> Ints:
        """Wall times of the last ticks."""
        return self._cycle_ns[: min(self.ticks, MEMORY)]

    def late_ns(self) -> Ints:
        """How late the last ticks began."""
        return self._late_ns[: min(self.ticks, MEMORY)]

    def _send(self, line: str) -> None:
        with suppress(OSError):
            self._link.send(line.encode(), socket.MSG_DONTWAIT)

    def _count(self, piece: Rows) -> None:
        timing = piece["timing"]
        numbers = timing["tick"]
        places = np.arange(self.ticks, self.ticks + len(piece)) % MEMORY
        self._cycle_ns[places] = timing["cycle_ns"]
        self._late_ns[places] = timing["late_ns"]
        before = int(numbers[0]) - 1 if self._last_tick is None else self._last_tick
        steps = np.diff(numbers, prepend=before)
        # A start that waits for something jumps ahead on purpose when it has come.
        self.skipped += int((steps[(steps > 1) & (numbers > 0)] - 1).sum())
        self._last_tick = int(numbers[-1])
        self.ticks += len(piece)
