"""The recorder's own process: takes ticks from the ring, writes `session.mcap`, shows progress.

It outlives a killed run: when its parent is gone it writes what is left, finishes the file and
ends. Run as `python -m hil.recorder_process` with its job as JSON on standard input.
"""

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

from hil.progress import Progress, make_progress
from hil.record_layout import tick_dtype
from hil.recorder_file import TickFile
from hil.recorder_ring import Ring
from hil.timing import pause

POLL_S = 0.02


def main() -> int:
    """Write one recording; the process's exit status."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # the run decides when it ends, not the terminal
    job: dict[str, Any] = json.load(sys.stdin)
    ring = Ring(job["ring"], tick_dtype(job["joints"], truth=job["truth"]))
    try:
        with TickFile(Path(job["file"]), ring.rows.dtype, job["meta"]) as file:
            progress = make_progress(job["duration_s"], shown=job["progress"])
            with progress:
                _drain(ring, file, progress, job["parent"])
    except OSError as error:
        sys.stderr.write(f"stride: recorder: {error.filename or job['file']}: {error.strerror}\n")
        return 1
    return 0


def _drain(ring: Ring, file: TickFile, progress: Progress, parent: int) -> None:
    while True:
        # Asked before the ring is emptied: what was put before the end is then still taken.
        ended = ring.finished or os.getppid() != parent
        pieces = ring.take()
        for piece in pieces:
            file.write(piece)
            progress.show(piece[-1])
            ring.release(len(piece))
        file.flush()
        if ended:
            return
        if not pieces:
            pause(POLL_S)


if __name__ == "__main__":
    sys.exit(main())
