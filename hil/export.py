"""A recording in formats that every tool reads."""

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from hil.interface import CORNERS, SIDES
from hil.recorder_file import TickFile
from hil.recording import Recording

QUATERNION = ("w", "x", "y", "z")


def write_csv(recording: Recording, stream: TextIO) -> None:
    """One line a tick, one column a number: `topic.field.element`."""
    columns = list(_columns(recording))
    writer = csv.writer(stream)
    writer.writerow([name for name, _ in columns])
    writer.writerows(zip(*(values.tolist() for _, values in columns), strict=True))


def write_json_lines(recording: Recording, stream: TextIO) -> None:
    """One object a tick, one nested object a topic; what is not finite is null."""
    topics = [name for name in recording.rows.dtype.names or () if recording.rows.dtype[name].names]
    for row in recording.rows:
        tick: dict[str, Any] = {"time_s": float(row["time_s"]), "time_ns": int(row["time_ns"])}
        for topic in topics:
            names = row[topic].dtype.names
            tick[topic] = {name: _plain(row[topic][name].tolist()) for name in names}
        stream.write(json.dumps(tick, allow_nan=False) + "\n")


def write_mcap(recording: Recording, path: Path) -> None:
    """The recording as a finished MCAP file, whatever was missing at the end of its own."""
    with TickFile(path, recording.rows.dtype, recording.meta) as file:
        file.write(recording.rows)


def _columns(recording: Recording) -> Iterator[tuple[str, np.ndarray[Any, np.dtype[Any]]]]:
    rows, joints = recording.rows, recording.meta["joints"]
    for topic in rows.dtype.names or ():
        names = rows.dtype[topic].names
        if not names:
            yield topic, rows[topic]
            continue
        for name in names:
            values = rows[topic][name]
            flat = values.reshape(len(rows), -1)
            for index, label in enumerate(labels_of(values.shape[1:], joints)):
                yield f"{topic}.{name}{label}", flat[:, index]


def labels_of(shape: tuple[int, ...], joints: list[str]) -> list[str]:
    """Names of the elements of a recorded field of this shape, each with a dot before it."""
    known: dict[tuple[int, ...], list[str]] = {
        (): [""],
        (2,): [f".{side}" for side in SIDES],
        (3,): [".x", ".y", ".z"],
        (4,): [f".{part}" for part in QUATERNION],
        (2, 4): [f".{side}.{corner}" for side in SIDES for corner in CORNERS],
    }
    if shape == (len(joints),):
        return [f".{joint}" for joint in joints]
    return known[shape]


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
