"""A recording played tick by tick: every tick as the loop once handed it to its sinks."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from hil.cycle import TickRecord
from hil.record_layout import topics
from hil.recording import Recording


def recorded_ticks(recording: Recording) -> Iterator[TickRecord]:
    """The ticks of a recording, oldest first, start-up (`time_s` < 0) included.

    As in a running loop, one record and its parts are filled again for every tick: copy what you
    keep. `truth` is None where the robot was not simulated. A recording of an older version may
    lack a field; it keeps the value of an object that was just made.
    """
    rows = recording.rows
    known = set(rows.dtype.names or ())
    parts = topics(len(recording.meta["joints"]), truth="truth" in known)
    record = TickRecord(time_ns=0, time_s=0.0, **{"truth": None, **parts})
    for row in rows:
        record.time_ns, record.time_s = int(row["time_ns"]), float(row["time_s"])
        for topic, part in parts.items():
            if topic in known:
                fill(part, row[topic])
        yield record


def fill(target: Any, row: Any) -> None:
    """Put one topic of a recorded tick into the object that it was made from."""
    for name in row.dtype.names:
        value = row[name]
        if isinstance(value, np.ndarray) and value.ndim:
            getattr(target, name)[...] = value
        elif hasattr(target, name):
            setattr(target, name, value.item())
