"""Ticks into an MCAP file: one channel a topic, log time = the time at which a tick was due."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType, Writer

from hil import __version__
from hil.record_layout import CDR_HEADER, message_definition

CHUNK_BYTES = 256 * 1024
"""About a third of a second of a small biped at 300 Hz: the most that a killed writer loses."""
METADATA = "stridebridge"


class TickFile:
    """An MCAP file being written; a context manager that finishes it."""

    def __init__(self, path: Path, dtype: np.dtype[np.void], meta: dict[str, Any]) -> None:
        self._stream = path.open("wb")
        self._writer = Writer(self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.LZ4)
        self._writer.start(profile="ros2", library=f"stridebridge {__version__}")
        self._writer.add_metadata(METADATA, {"meta": json.dumps(meta)})
        self._channels = {
            name: self._register(name, dtype[name])
            for name in dtype.names or ()
            if dtype[name].names
        }
        self._sequence = 0
        self.flush()

    def write(self, rows: np.ndarray[Any, np.dtype[np.void]]) -> None:
        """Append ticks, one after the other, so that a chunk holds whole ticks."""
        parts = [
            (channel, rows[topic].dtype.itemsize, rows[topic].tobytes())
            for topic, channel in self._channels.items()
        ]
        for index, time_ns in enumerate(rows["time_ns"].tolist()):
            for channel, size, data in parts:
                body = CDR_HEADER + data[index * size : (index + 1) * size]
                self._writer.add_message(channel, time_ns, body, time_ns, self._sequence)
            self._sequence += 1

    def flush(self) -> None:
        """Give finished chunks to the operating system."""
        self._stream.flush()

    def __enter__(self) -> "TickFile":
        return self

    def __exit__(self, *exc_info: object) -> None:
        self._writer.finish()
        self._stream.close()

    def _register(self, name: str, dtype: np.dtype[np.void]) -> int:
        message = f"stride_msgs/msg/{name.capitalize()}"
        schema = self._writer.register_schema(
            message, "ros2msg", message_definition(dtype).encode()
        )
        return int(self._writer.register_channel(f"/{name}", "cdr", schema))
