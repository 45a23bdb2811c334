"""Reading a run folder back: its meta data, and every tick that reached the disk."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from mcap.exceptions import McapError
from mcap.records import Channel, Message, Metadata, Schema
from mcap.stream_reader import StreamReader

from hil.errors import InputError
from hil.record_layout import CDR_HEADER, parse_definition
from hil.recorder_file import METADATA
from hil.trace import Trace

Rows = np.ndarray[Any, np.dtype[np.void]]


@dataclass(frozen=True, slots=True)
class Recording:
    """One recorded run."""

    meta: dict[str, Any]
    """As in meta.json."""
    rows: Rows
    """Ticks, with one nested record a topic (`hil.record_layout.tick_dtype`)."""
    complete: bool
    """Whether the file was finished; a killed recorder leaves one that is not."""

    def trace(self) -> Trace:
        """The walking ticks."""
        return Trace.from_ticks(self.rows)


def read_recording(folder: Path) -> Recording:
    """The recording in a run folder, up to its last whole chunk. Raises InputError."""
    path = folder / "session.mcap"
    if not path.is_file():
        raise InputError(f"{folder}: not a run folder: it has no session.mcap")
    contents = _Contents()
    complete = contents.read(path)
    if contents.meta is None:
        raise InputError(f"{path}: no recording of ours, or cut off before its first tick")
    return Recording(contents.meta, _rows(contents), complete)


class _Contents:
    """What is in an MCAP file, gathered record by record."""

    def __init__(self) -> None:
        self.meta: dict[str, Any] | None = None
        self.layouts: dict[int, np.dtype[np.void]] = {}
        self.topics: dict[int, tuple[str, int]] = {}
        self.bodies: dict[str, list[bytes]] = {}
        self.times: dict[str, list[int]] = {}

    def read(self, path: Path) -> bool:
        """Take every record; False if the file ends in the middle of one."""
        with path.open("rb") as stream:
            try:
                for record in StreamReader(stream).records:
                    self._take(record)
            except (McapError, ValueError, EOFError):
                return False
        return True

    def _take(self, record: Any) -> None:
        if isinstance(record, Message):
            topic, _ = self.topics[record.channel_id]
            self.bodies[topic].append(record.data[len(CDR_HEADER) :])
            self.times[topic].append(record.log_time)
        elif isinstance(record, Schema):
            self.layouts[record.id] = parse_definition(record.data.decode())
        elif isinstance(record, Channel):
            topic = record.topic.removeprefix("/")
            self.topics[record.id] = (topic, record.schema_id)
            self.bodies.setdefault(topic, [])
            self.times.setdefault(topic, [])
        elif isinstance(record, Metadata) and record.name == METADATA:
            self.meta = json.loads(record.metadata["meta"])


def _rows(contents: _Contents) -> Rows:
    """One row a tick, for the ticks of which every topic is there."""
    layouts = {topic: contents.layouts[schema] for topic, schema in contents.topics.values()}
    count = min((len(bodies) for bodies in contents.bodies.values()), default=0)
    nested = list(layouts.items())
    rows: Rows = np.zeros(count, np.dtype([("time_ns", "<i8"), ("time_s", "<f8"), *nested]))
    for topic, layout in nested:
        data = b"".join(contents.bodies[topic][:count])
        rows[topic] = np.frombuffer(data, layout)
        rows["time_ns"] = contents.times[topic][:count]
    rows["time_s"] = rows["timing"]["tick"] / (contents.meta or {})["rate_hz"]
    return rows
