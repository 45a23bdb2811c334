"""The binary layout of a tick in a recording: one topic a part of the tick.

Every topic is a record of fixed size whose bytes are, as they stand, the body of a little-endian
CDR message (OMG DDS-XTypes, plain CDR): fields of eight bytes first, then booleans, so that no
padding is needed. The same layout is written into the MCAP file as a ROS 2 message definition,
from which any reader (`hil.recording`, Foxglove, the ROS tools) finds every field.
"""

import math
import re
from collections.abc import Callable
from dataclasses import fields
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from hil.cycle import SafetyStatus, TickRecord
from hil.interface import (
    AppliedCommand,
    Estimate,
    Ints,
    JointCommand,
    Reference,
    SensorFrame,
    Truth,
    WalkStatus,
)
from hil.timing import TickTiming

CDR_HEADER = b"\x00\x01\x00\x00"
"""Encapsulation: plain CDR, little-endian."""

WORD = 8
"""Size of a float or an integer [bytes]."""

Getter = Callable[[TickRecord], tuple[Any, ...]]

ROS_TYPES = {"f": "float64", "i": "int64", "b": "bool"}
NUMPY_TYPES = {"float64": "<f8", "int64": "<i8", "bool": "?"}


def topics(n: int, *, truth: bool) -> dict[str, Any]:
    """An object of every topic's shape, for n joints; topic names are TickRecord's."""
    parts: dict[str, Any] = {
        "command": JointCommand.zeros(n),
        "applied": AppliedCommand.zeros(n),
        "frame": SensorFrame.empty(n),
        "estimate": blank_estimate(n),
        "reference": Reference(),
        "status": WalkStatus(),
        "safety": SafetyStatus(),
        "timing": TickTiming(),
    }
    if truth:
        parts["truth"] = _blank_truth(n)
    return parts


def tick_dtype(n: int, *, truth: bool) -> np.dtype[np.void]:
    """The record of one tick: `time_ns`, `time_s` and one nested record a topic.

    Every topic begins at a multiple of eight bytes, so that a tick is a row of words.
    """
    columns: list[tuple[str, Any]] = [("time_ns", np.dtype("<i8")), ("time_s", np.dtype("<f8"))]
    columns += [(name, topic_dtype(part)) for name, part in topics(n, truth=truth).items()]
    offsets, end = [], 0
    for _, layout in columns:
        offsets.append(end)
        end += -(-layout.itemsize // WORD) * WORD
    names, formats = zip(*columns, strict=True)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": end})


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
    """Copies ticks into rows of an array of `tick_dtype`.

    All arrays of floats are joined in one operation, and so are all those of integers; single
    floats and integers are copied as one list each. A last operation puts these words into the
    order of the row. Booleans, which are few, follow one by one.
    """

    def __init__(self, rows: np.ndarray[Any, np.dtype[np.void]]) -> None:
        words = rows.dtype.itemsize // WORD
        self._rows = np.frombuffer(rows, np.int64).reshape(len(rows), words)
        self._buffer = np.zeros(words + 1, dtype=np.int64)
        self._order = np.full(words, words)  # the last word of the buffer stays 0
        self._filled = 0
        columns = _columns(rows.dtype)
        floats = [column for column in columns if column.dtype == np.float64]
        whole = [column for column in columns if column.dtype == np.int64]
        flags = [column for column in columns if column.dtype == np.bool_]
        self._arrays = [self._area(kind, single=False) for kind in (floats, whole)]
        self._singles = [self._area(kind, single=True) for kind in (floats, whole)]
        self._flags = _getter(flags)
        self._flag_columns = [_nested(rows, column.name) for column in flags]

    def _area(self, columns: list["_Column"], *, single: bool) -> tuple[Getter, Any]:
        """How to get some fields of one type, and the part of the buffer that takes them."""
        chosen = [column for column in columns if (column.shape == ()) is single]
        begin = self._filled
        for column in chosen:
            size = math.prod(column.shape)
            words = self._filled + np.arange(size)
            self._order[column.word : column.word + size] = words
            self._filled += size
        return _getter(chosen), self._buffer[begin : self._filled].view(columns[0].dtype)

    def words(self, row: int) -> Ints:
        """One row as it lies in memory, shape (words,)."""
        words: Ints = self._rows[row]
        return words

    def write(self, row: int, record: TickRecord) -> None:
        """Fill one row."""
        for values, area in self._arrays:
            np.concatenate(values(record), axis=None, out=area)
        for values, area in self._singles:
            area[:] = values(record)
        np.take(self._buffer, self._order, out=self._rows[row], mode="clip")
        for column, value in zip(self._flag_columns, self._flags(record), strict=True):
            column[row] = value


class _Column(NamedTuple):
    """One field of a tick's row."""

    name: str
    """Dotted, as an attribute of TickRecord."""
    dtype: np.dtype[Any]
    word: int
    """Where its first word is in the row; of no use for a boolean."""
    shape: tuple[int, ...]


def _columns(tick: np.dtype[np.void]) -> list[_Column]:
    """Every field of a tick, those of topics included."""
    found = []
    for name, (layout, offset, *_) in (tick.fields or {}).items():
        inner = layout.fields or {"": (layout, 0)}
        for key, (dtype, start, *_) in inner.items():
            path = f"{name}.{key}" if key else name
            found.append(_Column(path, dtype.base, (offset + start) // WORD, dtype.shape))
    return found


def _nested(rows: np.ndarray[Any, np.dtype[np.void]], path: str) -> np.ndarray[Any, Any]:
    topic, _, name = path.partition(".")
    return rows[topic][name] if name else rows[topic]


def _getter(columns: list[_Column]) -> Getter:
    return attrgetter(*(column.name for column in columns))


def blank_estimate(n: int) -> Estimate:
    """An estimate of n joints in which every number is 0, no two arrays the same."""
    base = (np.zeros(3), np.zeros(4), np.zeros(3), np.zeros(3))
    joints, com = (np.zeros(n), np.zeros(n)), (np.zeros(3), np.zeros(3))
    loads, contact = (np.zeros((2, 4)), np.zeros(2)), np.zeros(2, dtype=np.bool_)
    return Estimate(0, *base, *joints, *com, *loads, contact, 0.0)


def _blank_truth(n: int) -> Truth:
    """As `blank_estimate`: no two arrays the same."""
    base = (np.zeros(3), np.zeros(4), np.zeros(3), np.zeros(3))
    joints, com = (np.zeros(n), np.zeros(n)), (np.zeros(3), np.zeros(3))
    return Truth(0, *base, *joints, *com, np.zeros((2, 4)), np.zeros(2))
