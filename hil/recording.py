"""Reading a run folder back: its meta data, and every tick that reached the disk."""

import json
import struct
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from mcap.exceptions import McapError
from mcap.records import Channel, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import MCAP0_MAGIC

from hil.errors import InputError
from hil.record_layout import CDR_HEADER, parse_definition
from hil.recorder_file import METADATA
from hil.trace import Trace

RECORD_HEADER = struct.Struct("<BQ")

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
    if contents.meta is None or not contents.topics:
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
        """Take every record; False if the file is cut off or damaged, then up to there."""
        whole = _whole_records(path.read_bytes())
        try:
            for record in StreamReader(BytesIO(whole), validate_crcs=True).records:
                self._take(record)
        except (McapError, ValueError, RuntimeError, struct.error):
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


def _whole_records(data: bytes) -> bytes:
    """The file up to its last whole record: an opcode, a length of eight bytes, the content."""
    end = len(MCAP0_MAGIC)
    while end + RECORD_HEADER.size <= len(data):
        _, length = RECORD_HEADER.unpack_from(data, end)
        if end + RECORD_HEADER.size + length > len(data):
            return data[:end]
        end += RECORD_HEADER.size + length
    return data


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
