"""The binary layout of a tick in a recording: one topic a part of the tick.

Every topic is a record of fixed size whose bytes are, as they stand, the body of a little-endian
CDR message (OMG DDS-XTypes, plain CDR): fields of eight bytes first, then booleans, so that no
padding is needed. The same layout is written into the MCAP file as a ROS 2 message definition,
from which any reader (`hil.recording`, Foxglove, the ROS tools) finds every field.
"""

import re
from dataclasses import fields
from operator import attrgetter
from typing import Any

import numpy as np

from hil.cycle import TickRecord
from hil.interface import (
    AppliedCommand,
    Estimate,
    JointCommand,
    Reference,
    SensorFrame,
    Truth,
    WalkStatus,
)
from hil.timing import TickTiming

CDR_HEADER = b"\x00\x01\x00\x00"
"""Encapsulation: plain CDR, little-endian."""

ROS_TYPES = {"f": "float64", "i": "int64", "b": "bool"}
NUMPY_TYPES = {"float64": "<f8", "int64": "<i8", "bool": "?"}


def topics(n: int, *, truth: bool) -> dict[str, Any]:
    """An object of every topic's shape, for n joints; topic names are TickRecord's."""
    parts: dict[str, Any] = {
        "command": JointCommand.zeros(n),
        "applied": AppliedCommand.zeros(n),
        "frame": SensorFrame.empty(n),
        "estimate": _blank_estimate(n),
        "reference": Reference(),
        "status": WalkStatus(),
        "timing": TickTiming(),
    }
    if truth:
        parts["truth"] = _blank_truth(n)
    return parts


def tick_dtype(n: int, *, truth: bool) -> np.dtype[np.void]:
    """The record of one tick: `time_ns`, `time_s` and one nested record a topic."""
    nested = [(name, topic_dtype(part)) for name, part in topics(n, truth=truth).items()]
    return np.dtype([("time_ns", "<i8"), ("time_s", "<f8"), *nested])


def topic_dtype(part: Any) -> np.dtype[np.void]:
    """The record of one part of a tick, wide fields first, without padding."""
    columns = []
    for item in fields(part):
        value = np.asarray(getattr(part, item.name))
        columns.append((item.name, value.dtype.newbyteorder("<"), value.shape))
    columns.sort(key=lambda column: -column[1].itemsize)
    return np.dtype(columns)


def message_definition(dtype: np.dtype[np.void]) -> str:
    """The ROS 2 message definition of a topic; an array of shape (2, 4) is flat in it."""
    lines = []
    for name in dtype.names or ():
        column = dtype[name]
        shape = f"[{int(np.prod(column.shape))}]" if column.shape else ""
        comment = f"  # shape {column.shape}" if len(column.shape) > 1 else ""
        lines.append(f"{ROS_TYPES[column.base.kind]}{shape} {name}{comment}")
    return "\n".join(lines)


def parse_definition(text: str) -> np.dtype[np.void]:
    """The layout that a message definition describes. Raises ValueError on any other type."""
    columns = []
    for line in text.splitlines():
        match = re.match(r"(\w+)(?:\[(\d+)\])? (\w+)(?:  # shape \(([\d, ]+)\))?$", line)
        if match is None or match[1] not in NUMPY_TYPES:
            raise ValueError(f"not a field of a recording: {line!r}")
        shape: tuple[int, ...] = (int(match[2]),) if match[2] else ()
        if match[4]:
            shape = tuple(int(part) for part in match[4].split(","))
        columns.append((match[3], NUMPY_TYPES[match[1]], shape))
    return np.dtype(columns)


class TickWriter:
    """Copies ticks into rows of an array of `tick_dtype`, one assignment a field."""

    def __init__(self, rows: np.ndarray[Any, np.dtype[np.void]]) -> None:
        self._time_ns, self._time_s = rows["time_ns"], rows["time_s"]
        parts = [name for name in rows.dtype.names or () if rows.dtype[name].names]
        self._parts = []
        for part in parts:
            names = rows.dtype[part].names or ()
            columns = [rows[part][name] for name in names]
            self._parts.append((attrgetter(part), attrgetter(*names), columns))

    def write(self, row: int, record: TickRecord) -> None:
        """Fill one row."""
        self._time_ns[row] = record.time_ns
        self._time_s[row] = record.time_s
        for part, values, columns in self._parts:
            for column, value in zip(columns, values(part(record)), strict=True):
                column[row] = value


def _blank_estimate(n: int) -> Estimate:
    three, four = np.zeros(3), np.zeros(4)
    loads, contact = (np.zeros((2, 4)), np.zeros(2)), np.zeros(2, dtype=np.bool_)
    joints = (np.zeros(n), np.zeros(n))
    return Estimate(0, three, four, three, three, *joints, three, three, *loads, contact, 0.0)


def _blank_truth(n: int) -> Truth:
    three, four = np.zeros(3), np.zeros(4)
    joints, loads = (np.zeros(n), np.zeros(n)), (np.zeros((2, 4)), np.zeros(2))
    return Truth(0, three, four, three, three, *joints, three, three, *loads)
