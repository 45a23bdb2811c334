"""A ring of tick records in memory that two processes share, without a name that could leak.

One process puts, one takes. The ring lives in an unlinked temporary file: when both are gone,
however they went, so is it.
"""

import mmap
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

SLOTS = 2048
"""6.8 s at 300 Hz: more than a start of the writer or a stall of the disk takes."""
HEADER = np.dtype([("put", "<i8"), ("taken", "<i8"), ("finished", "<i8"), ("padding", "<i8", 5)])

Rows = np.ndarray[Any, np.dtype[np.void]]


class Ring:
    """`slots` records of one dtype, and how many were put and taken so far."""

    def __init__(self, descriptor: int, dtype: np.dtype[np.void], slots: int = SLOTS) -> None:
        self.descriptor = descriptor
        self.slots = slots
        size = HEADER.itemsize + slots * dtype.itemsize
        if os.fstat(descriptor).st_size < size:
            os.ftruncate(descriptor, size)
        memory = mmap.mmap(descriptor, size)
        self._header = np.frombuffer(memory, HEADER, 1)
        self._put, self._taken = self._header["put"], self._header["taken"]
        self._finished = self._header["finished"]
        self.rows: Rows = np.frombuffer(memory, dtype, slots, HEADER.itemsize)

    @classmethod
    def create(cls, dtype: np.dtype[np.void]) -> "Ring":
        """A new ring in main memory where the system offers a file system for that."""
        folder = "/dev/shm" if Path("/dev/shm").is_dir() else None
        with tempfile.TemporaryFile(dir=folder) as file:
            return cls(os.dup(file.fileno()), dtype)

    @property
    def waiting(self) -> int:
        """Records put and not yet taken."""
        return int(self._put[0] - self._taken[0])

    @property
    def full(self) -> bool:
        """Whether there is no row to write into."""
        return self.waiting >= self.slots

    @property
    def finished(self) -> bool:
        """Whether nothing more will be put."""
        return bool(self._finished[0])

    @property
    def next_row(self) -> int:
        """Row to write before `publish`."""
        return int(self._put[0]) % self.slots

    def publish(self) -> None:
        """Hand the next row over to the other process."""
        self._put[0] += 1

    def take(self) -> list[Rows]:
        """What is waiting, oldest first, in at most two pieces; `release` frees the rows."""
        first, waiting = int(self._taken[0]) % self.slots, self.waiting
        end = min(first + waiting, self.slots)
        pieces = [self.rows[first:end], self.rows[: first + waiting - end]]
        return [piece for piece in pieces if len(piece)]

    def release(self, count: int) -> None:
        """Free the oldest rows."""
        self._taken[0] += count

    def finish(self) -> None:
        """Say that nothing more will be put."""
        self._finished[0] = 1
