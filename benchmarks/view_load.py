"""Does the live view delay a tick? One run in real time, the view on and off in turns.

    python benchmarks/view_load.py [--seconds 60] [--block 5] [--priority 40]

A dry run of the minibiped on pseudo-terminals at 300 Hz, its web view open, and a client that reads
the scene's stream as a browser would (no browser: that draws on another machine). Every other block
the view's process is stopped (SIGSTOP) and the run's ticks are not copied for it. Both kinds of
block share one run and one machine: compare them, not the figures of different days. On a busy
machine `--lockstep` cannot miss a deadline, and `--priority` gives the loop and the virtual robot,
not the view, SCHED_FIFO.
"""

import argparse
import os
import signal
import threading
from contextlib import closing, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hil.compose import build
from hil.cycle import TickRecord
from hil.loop import Loop
from hil.recorder import Recorder
from hil.request import RunRequest
from hil.run_folder import make_meta
from hil.view.attendance import attend
from hil.view.feed import ViewFeed

Cost = dict[bool, list[tuple[int, int]]]
"""Tick and lateness [ns], by whether the view was on."""
SETTLE = 60
"""Ticks after a change that count for neither."""


class Switch:
    """A sink that hands ticks to the view in every other block, and keeps what they cost."""

    def __init__(self, feed: ViewFeed, block: int) -> None:
        self._feed, self._block = feed, block
        self.cost: Cost = {True: [], False: []}
        self._on = True

    def put(self, record: TickRecord) -> None:
        tick = record.timing.tick
        if tick < 0:
            return
        on = tick // self._block % 2 == 0
        if on is not self._on:
            self._on = on
            os.kill(self._feed._process.pid, signal.SIGCONT if on else signal.SIGSTOP)
        if on:
            self._feed.put(record)
        if tick % self._block > SETTLE:
            self.cost[on].append((record.timing.cycle_ns, record.timing.late_ns))


def read_stream(place: str, counts: list[int]) -> None:
    """Read the scene as a page that only looks on does."""
    address = place.rsplit("http", 1)[1].removeprefix("://").rstrip("/\n")
    with (
        suppress(ConnectionClosed),
        connect(f"ws://{address}/state?sid=bench", max_size=None) as stream,
    ):
        for message in stream:
            counts.append(len(message))
            if isinstance(message, bytes):
                stream.send("state_ack")


def table(cost: Cost) -> str:
    lines = ["| | p50 ms | p90 ms | p99 ms | max ms |", "|---|---|---|---|---|"]
    found = {}
    columns = (("tick", 0), ("late", 1)) if any(late for _, late in cost[True]) else (("tick", 0),)
    for name, column in columns:
        for on in (False, True):
            values = np.array(cost[on])[:, column] * 1e-6
            found[name, on] = np.percentile(values, (50, 90, 99, 100))
            figures = " | ".join(f"{value:.3f}" for value in found[name, on])
            lines.append(f"| {name}, view {'on' if on else 'off'} | {figures} |")
        ratio = found[name, True] / found[name, False]
        lines.append(f"| {name}, on / off | " + " | ".join(f"{r:.2f}" for r in ratio) + " |")
    return "\n".join(lines)


def raise_priority(priority: int) -> None:
    """This process and the virtual robot's; what is started later is as it was."""
    own = os.getpid()
    children = Path(f"/proc/{own}/task/{own}/children").read_text().split()
    threads = [int(task.name) for pid in children for task in Path(f"/proc/{pid}/task").iterdir()]
    for thread in threads:
        os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
    os.sched_setscheduler(own, policy, os.sched_param(priority))


def main() -> None:
    parser = argparse.ArgumentParser(description="The cost of the live view.")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--block", type=float, default=5.0)
    parser.add_argument("--priority", type=int)
    parser.add_argument("--lockstep", action="store_true", help="held back to 300 Hz; no lateness")
    options = parser.parse_args()
    request = RunRequest.checked(
        realtime=not options.lockstep, view="web", duration_s=options.seconds
    )
    session = build(request)
    if options.priority is not None:
        raise_priority(options.priority)
    attendance = attend(session)
    if attendance.helm is None or attendance.feed is None:
        raise SystemExit("no view")
    attendance.helm.started = True
    feed = attendance.feed
    counts = []
    reader = threading.Thread(target=read_stream, args=(feed.place, counts), daemon=True)
    with TemporaryDirectory() as folder, closing(attendance):
        session.backend.open()
        recorder = Recorder(Path(folder), make_meta(session), truth=True, progress=False)
        attendance.sinks(recorder.last_row)
        switch = Switch(feed, round(options.block * 300))
        reader.start()
        with recorder:
            loop = Loop(session, (recorder, switch), helm=attendance.helm, pacer=attendance.pacer)
            loop.run()
        os.kill(feed._process.pid, signal.SIGCONT)
    for fault in loop.outcome.faults:
        print(fault)
    print(f"{len(switch.cost[False])} ticks off, {len(switch.cost[True])} on; "
          f"{len(counts)} messages of {np.median(counts):.0f} bytes read")  # fmt: skip
    if not all(switch.cost.values()):
        raise SystemExit("it did not walk; a busy machine cannot do it in real time: --lockstep")
    print(table(switch.cost))


if __name__ == "__main__":
    main()
