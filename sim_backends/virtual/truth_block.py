"""Ground truth in shared memory: written at every grid point, read without asking anybody."""

import mmap
from pathlib import Path

import numpy as np

from hil.errors import BackendError
from hil.interface import Truth

_FIELDS = (
    ("base_position", 3),
    ("base_orientation", 4),
    ("base_linear_velocity", 3),
    ("base_angular_velocity", 3),
    ("joint_position", 0),
    ("joint_velocity", 0),
    ("com", 3),
    ("com_velocity", 3),
    ("foot_force", 8),
    ("toe_force", 2),
)
"""Attributes of Truth and their numbers of values; 0 stands for one a joint."""
_HEAD = 3
_ATTEMPTS = 1000


class TruthBlock:
    """One Truth in a file that both sides map.

    Layout: a counter and the times of two slots as int64, then the fields of both slots as
    float64. The counter's parity says which slot is complete; the writer works on the other one,
    so a reader never waits for it, even if it was put to sleep in the middle.
    """

    def __init__(self, path: Path, joints: int, create: bool = False) -> None:
        """Map the block at `path`, made anew by the writer. Raises BackendError."""
        widths = [width or joints for _, width in _FIELDS]
        width = sum(widths)
        size = 8 * (_HEAD + 2 * width)
        try:
            if create:
                path.write_bytes(bytes(size))
            with path.open("r+b") as file:
                self._map = mmap.mmap(file.fileno(), size)
        except (OSError, ValueError) as error:
            raise BackendError(f"truth of the virtual robot, {path}: {error}") from error
        self._head = np.frombuffer(self._map, np.int64, _HEAD)
        self._values = np.frombuffer(self._map, np.float64, 2 * width, 8 * _HEAD).reshape(2, width)
        self._slices = []
        start = 0
        for (name, _), size in zip(_FIELDS, widths, strict=True):
            self._slices.append((name, slice(start, start + size)))
            start += size
        self._copy = np.zeros(start)
        views = {name: self._copy[part] for name, part in self._slices}
        views["foot_force"] = views["foot_force"].reshape(2, 4)
        self._truth = Truth(0, **views)

    def write(self, truth: Truth, offset_ns: int) -> None:
        """Publish a truth; `offset_ns` is added to its time."""
        count = int(self._head[0]) + 1
        slot = count % 2
        self._head[1 + slot] = truth.time_ns + offset_ns
        values = self._values[slot]
        np.concatenate([getattr(truth, name).ravel() for name, _ in _FIELDS], out=values)
        self._head[0] = count

    def read(self) -> Truth:
        """The newest truth; the object is reused. Raises BackendError if it cannot be had whole."""
        for _ in range(_ATTEMPTS):
            count = int(self._head[0])
            slot = count % 2
            self._copy[:] = self._values[slot]
            self._truth.time_ns = int(self._head[1 + slot])
            if count == self._head[0]:
                return self._truth
        raise BackendError("truth of the virtual robot: it changes faster than it can be read")

    def close(self) -> None:
        """Let go of the views; the mapping ends with the last of them."""
        self._head, self._values = np.zeros(_HEAD, np.int64), np.zeros((2, 0))
