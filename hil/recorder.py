"""The loop's end of the recorder: a tick is copied into shared memory, nothing else.

A process of its own (`hil.recorder_process`) packs it into `session.mcap`.
"""

import os
import subprocess
from pathlib import Path
from typing import Any

from hil.child_process import spawn
from hil.cycle import TickRecord
from hil.errors import BackendError
from hil.interface import Ints
from hil.record_layout import TickWriter, tick_dtype
from hil.recorder_ring import Ring
from hil.timing import pause

CLOSE_TIMEOUT_S = 60.0


class Recorder:
    """Records one run; a context manager.

    In lockstep `put` waits while the ring is full, since nothing is late there; in real time it
    drops the tick and counts it.
    """

    def __init__(self, folder: Path, meta: dict[str, Any], *, truth: bool, progress: bool) -> None:
        joints = len(meta["joints"])
        self.dropped = 0
        self._lockstep = bool(meta["lockstep"])
        self._ring = Ring.create(tick_dtype(joints, truth=truth))
        self._writer = TickWriter(self._ring.rows)
        job = {
            "file": str(folder / "session.mcap"),
            "joints": joints,
            "truth": truth,
            "progress": progress,
            "parent": os.getpid(),
            "ring": self._ring.descriptor,
            "duration_s": meta["request"]["duration_s"],
            "meta": meta,
        }
        self._row = 0
        self._process = spawn("hil.recorder_process", job, [self._ring.descriptor])

    def put(self, record: TickRecord) -> None:
        """Copy a tick into the ring."""
        if self._ring.full and not self._has_room():
            self.dropped += 1
            return
        self._row = self._ring.next_row
        self._writer.write(self._row, record)
        self._ring.publish()

    def last_row(self) -> Ints:
        """The tick that was put last, as words of `tick_dtype`: valid until the next one."""
        return self._writer.words(self._row)

    def close(self) -> None:
        """Wait until everything is on disk. Raises BackendError if the writer failed."""
        self._ring.finish()
        try:
            status = self._process.wait(CLOSE_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            status = self._process.wait()
        os.close(self._ring.descriptor)
        if status != 0:
            raise BackendError(f"the recorder ended with status {status}: session.mcap is cut off")

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.close()

    def _has_room(self) -> bool:
        while self._lockstep and self._ring.full and self._process.poll() is None:
            pause(0.001)
        return not self._ring.full
