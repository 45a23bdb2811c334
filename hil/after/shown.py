"""A recording in the live view, as if it were a run."""

import itertools
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hil.after.ticks import recorded_ticks
from hil.errors import InputError
from hil.plots.plotted_run import PlottedRun
from hil.record_layout import TickWriter, tick_dtype
from hil.request import ViewName
from hil.steering.limits import steer_limits
from hil.timing import pause, stopwatch_ns
from hil.view.feed import ViewFeed


@dataclass(frozen=True, slots=True)
class Showing:
    """How a recording is shown."""

    view: ViewName
    slower: float = 1.0
    """Seconds of showing for a second of the run."""
    begin_s: float | None = None
    """Time of the run at which it begins; none: at the first recorded tick."""
    times: int | None = None
    """How often; none: until the operator has seen enough."""


def open_view(run: PlottedRun, showing: Showing) -> ViewFeed:
    """The view, up and waiting for ticks. Raises InputError where it cannot be shown."""
    meta = run.meta
    bounds = asdict(steer_limits(run.description)) | {"push": 0.0}
    job = {
        "view": showing.view,
        "robot": meta["request"]["robot"],
        "overrides": list(meta["request"]["overrides"]),
        "joints": len(meta["joints"]),
        "truth": "truth" in (run.rows.dtype.names or ()),
        "rate_hz": meta["rate_hz"],
        "rung": f"{meta['rung']}, recorded",
        "steered": False,
        "bounds": bounds,
    }
    return ViewFeed(job, meta["rate_hz"])


def show_recording(run: PlottedRun, showing: Showing, feed: ViewFeed) -> None:
    """Hand every recorded tick to the view at its time, again and again.

    The caller closes the feed. Raises InputError for a beginning behind the recording's end.
    """
    first = 0 if showing.begin_s is None else int(np.searchsorted(run.time_s, showing.begin_s))
    if first >= len(run.rows):
        raise InputError(f"--from {showing.begin_s}: {run.name} ends at {run.time_s[-1]:.2f} s")
    rounds: Iterable[Any] = itertools.count() if showing.times is None else range(showing.times)
    for _ in rounds:
        _play(run, first, showing.slower, feed)


def _play(run: PlottedRun, first: int, slower: float, feed: ViewFeed) -> None:
    """Once, from a tick (place in the recording) to the end."""
    packed = np.zeros(1, tick_dtype(len(run.joints), truth="truth" in (run.rows.dtype.names or ())))
    writer = TickWriter(packed)
    feed.follow(lambda: writer.words(0))
    now_s = [0.0]
    feed.facts = lambda: {
        "statistics": {},
        "faults": [fault for fault in run.faults if fault["time_s"] <= now_s[0]],
    }
    began, due = stopwatch_ns(), run.rows["time_ns"][first:]
    ticks = itertools.islice(recorded_ticks(run.recording), first, None)
    for record, time_ns in zip(ticks, (due - due[0]).tolist(), strict=True):
        ahead_s = (began + slower * time_ns - stopwatch_ns()) * 1e-9
        if ahead_s > 0:
            pause(ahead_s)
        now_s[0] = record.time_s
        writer.write(0, record)
        feed.put(record)
