"""What a tick pays the recorder, while its writer runs and while it stands still.

    python benchmarks/recorder_stall.py

Paced ticks of a small biped at 300 Hz, each handed to a real recorder; in the middle third its
process is stopped (SIGSTOP) for 2 s, as a disk that hangs would stop it. Printed are percentiles
of the time that handing over took, and what was lost. Wall times depend on the machine; the rows
belong to one run and can be compared with each other.
"""

import os
import signal
import tempfile
from pathlib import Path
from time import perf_counter_ns, sleep

import numpy as np

from hil.cycle import SafetyStatus, TickRecord
from hil.record_layout import topics
from hil.recorder import Recorder
from hil.recording import read_recording

JOINTS, RATE_HZ, STALL_S = 12, 300, 2.0
META = {
    "joints": [f"joint{number}" for number in range(JOINTS)],
    "lockstep": False,
    "rate_hz": RATE_HZ,
    "request": {"duration_s": 3 * STALL_S},
}


def main() -> None:
    """Record, stall, record, and print a row a third."""
    record = TickRecord(0, 0.0, **topics(JOINTS, truth=True))
    record.safety = SafetyStatus(walking=True)
    third = round(STALL_S * RATE_HZ)
    took = np.zeros(3 * third)
    with tempfile.TemporaryDirectory() as folder:
        recorder = Recorder(Path(folder), META, truth=True, progress=False)
        sleep(1.0)  # the writer is up
        began = perf_counter_ns()
        for tick in range(3 * third):
            if tick in (third, 2 * third):
                stop = tick == third
                os.kill(recorder._process.pid, signal.SIGSTOP if stop else signal.SIGCONT)
            record.timing.tick, record.time_ns = tick, tick * 10**9 // RATE_HZ
            handing = perf_counter_ns()
            recorder.put(record)
            took[tick] = perf_counter_ns() - handing
            sleep(max(0.0, (began + record.time_ns + 10**9 // RATE_HZ - perf_counter_ns()) * 1e-9))
        recorder.close()
        kept = len(read_recording(Path(folder)).rows)
    for name, part in zip(("before", "stalled", "after"), np.split(took / 1e3, 3), strict=True):
        low, middle, high = np.percentile(part, (0, 50, 99))
        print(
            f"{name:8} min {low:6.1f}  p50 {middle:6.1f}  p99 {high:6.1f}  max {part.max():7.1f} us"
        )
    print(f"{kept} of {3 * third} ticks recorded, {recorder.dropped} dropped")


if __name__ == "__main__":
    main()
