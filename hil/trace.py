"""The walking ticks of a run, in memory: what reports, pictures and comparisons are made from."""

from dataclasses import dataclass, fields
from operator import attrgetter
from typing import Any

import numpy as np

from hil.cycle import TickRecord
from hil.interface import Bools, Floats, Ints

MOTION = (
    "base_position",
    "base_orientation",
    "com",
    "com_velocity",
    "joint_position",
    "foot_force",
    "toe_force",
)
"""Columns from the truth where it is known, else from the estimate."""
STATUS = (
    "phase",
    "stance",
    "steps",
    "walking",
    "foot_flat",
    "stabilizer_iterations",
    "stabilizer_limited",
    "heading",
)
REFERENCE = ("speed", "lateral", "water_level")
TIMING = ("control_ns", "cycle_ns")


@dataclass(frozen=True, slots=True)
class Trace:
    """Columns over T walking ticks, T = 0 first."""

    time_s: Floats
    """Shape (T,) [s]."""
    base_position: Floats
    """(T, 3) [m]"""
    base_orientation: Floats
    """(T, 4), base to world, (w, x, y, z)."""
    com: Floats
    """(T, 3) [m]"""
    com_velocity: Floats
    """(T, 3) [m/s]"""
    joint_position: Floats
    """(T, n) [rad]"""
    foot_force: Floats
    """Corner forces, (T, 2, 4) [N]."""
    toe_force: Floats
    """(T, 2) [N]"""
    phase: Floats
    stance: Ints
    steps: Ints
    walking: Bools
    foot_flat: Bools
    stabilizer_iterations: Ints
    stabilizer_limited: Bools
    heading: Floats
    """Heading that the controller tracked [rad], (T,)."""
    speed: Floats
    """Commanded sagittal speed [m/s], (T,)."""
    lateral: Floats
    """Commanded coronal speed [m/s], (T,)."""
    water_level: Floats
    """Level of the liquid above the floor [m], (T,)."""
    control_ns: Ints
    """Wall time of the controller's step, (T,)."""
    cycle_ns: Ints
    """Wall time of the whole tick, (T,)."""

    def __len__(self) -> int:
        return len(self.time_s)

    @property
    def yaw(self) -> Floats:
        """Yaw of the root body [rad], unwrapped, (T,)."""
        w, x, y, z = self.base_orientation.T
        return np.unwrap(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))

    def part(self, first: int, last: int | None) -> "Trace":
        """The ticks from `first` on, before `last`."""
        return Trace(**{item.name: getattr(self, item.name)[first:last] for item in fields(self)})

    @classmethod
    def from_ticks(cls, rows: np.ndarray[Any, np.dtype[np.void]]) -> "Trace":
        """The walking ticks among recorded ones (`hil.record_layout.tick_dtype`)."""
        walked = rows[(rows["time_s"] >= 0) & rows["safety"]["walking"]]
        motion = walked["truth" if "truth" in (rows.dtype.names or ()) else "estimate"]
        columns = {"time_s": walked["time_s"]}
        for names, source in (
            (MOTION, motion),
            (STATUS, walked["status"]),
            (REFERENCE, walked["reference"]),
            (TIMING, walked["timing"]),
        ):
            columns.update({name: source[name] for name in names})
        return cls(**columns)


class TraceSink:
    """Collects the walking ticks of a run whose length is known, without allocating in a tick."""

    def __init__(self, joints: int, ticks: int) -> None:
        shapes: dict[str, tuple[int, ...]] = {
            "base_position": (3,),
            "base_orientation": (4,),
            "com": (3,),
            "com_velocity": (3,),
            "joint_position": (joints,),
            "foot_force": (2, 4),
            "toe_force": (2,),
        }
        kinds: dict[Any, type] = {Ints: np.int64, Bools: np.bool_}
        self._rows = 0
        self._columns: dict[str, np.ndarray[Any, np.dtype[Any]]] = {
            item.name: np.zeros((ticks, *shapes.get(item.name, ())), kinds.get(item.type, float))
            for item in fields(Trace)
        }
        self._parts = [
            (attrgetter(*names), [self._columns[name] for name in names])
            for names in (MOTION, STATUS, REFERENCE, TIMING)
        ]

    def put(self, record: TickRecord) -> None:
        """Take one tick, if it is a walking one."""
        row = self._rows
        full = row == len(self._columns["time_s"])
        if record.time_s < 0 or full or not record.safety.walking:
            return
        self._columns["time_s"][row] = record.time_s
        sources = (
            record.truth or record.estimate,
            record.status,
            record.reference,
            record.timing,
        )
        for source, (values, columns) in zip(sources, self._parts, strict=True):
            for column, value in zip(columns, values(source), strict=True):
                column[row] = value
        self._rows = row + 1

    def trace(self) -> Trace:
        """What was collected so far."""
        return Trace(**{name: column[: self._rows] for name, column in self._columns.items()})
