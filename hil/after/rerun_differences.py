"""Where two records of the same ticks differ, number by number."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from hil.export import labels_of
from hil.interface import Bools, Floats
from hil.recording import Rows

UNITS = {
    "position": "rad",
    "velocity": "rad/s",
    "stiffness": "N·m/rad",
    "damping": "N·m·s/rad",
    "torque": "N·m",
    "base_position": "m",
    "base_linear_velocity": "m/s",
    "base_angular_velocity": "rad/s",
    "joint_position": "rad",
    "joint_velocity": "rad/s",
    "com": "m",
    "com_velocity": "m/s",
    "foot_force": "N",
    "toe_force": "N",
    "supply_voltage": "V",
    "foot_target": "m",
    "heading": "rad",
    "alteration": "m",
    "wanted_speed": "m/s",
}
"""Of the fields that have one."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One number of a tick that is not what it was."""

    topic: str
    """`estimate`, `command` or `status`."""
    field: str
    element: str
    """Joint, foot, corner or axis; empty for a field of one number."""
    first_tick: int
    time_s: float
    """Of the first tick that differs."""
    ticks: int
    """How many do."""
    largest: float
    """Largest difference, in `unit`; infinite where only one of the two is a number."""
    unit: str


def find_differences(
    rows: Rows,
    again: Rows,
    estimates: Bools,
    commands: Bools,
    meta: dict[str, Any],
    tolerance: float,
) -> list[Difference]:
    """Every number of estimate, command and status that differs, the earliest first.

    Compared are the estimates of some ticks, and commands and status of others, (T,) each. Of two
    that begin to differ in one tick, the command comes after what it was made from.
    """
    found = []
    for topic, chosen in (("estimate", estimates), ("command", commands), ("status", commands)):
        then, now = rows[topic][chosen], again[topic][chosen]
        ticks, times = rows["timing"]["tick"][chosen], rows["time_s"][chosen]
        for name in (name for name in then.dtype.names or () if name in (now.dtype.names or ())):
            apart = _apart(then[name], now[name])
            labels = labels_of(then[name].shape[1:], meta["joints"])
            for column in np.flatnonzero((apart > tolerance).any(axis=0)).tolist():
                differs = np.flatnonzero(apart[:, column] > tolerance)
                first, largest = int(differs[0]), float(apart[differs, column].max())
                element = labels[column].removeprefix(".")
                where = (topic, name, element, int(ticks[first]), float(times[first]))
                found.append(Difference(*where, len(differs), largest, UNITS.get(name, "")))
    found.sort(key=lambda one: one.first_tick)
    return found


def _apart(then: np.ndarray[Any, Any], now: np.ndarray[Any, Any]) -> Floats:
    """Absolute differences, (T, elements): 0 for two NaN, infinite for one."""
    a, b = (_flat(part) for part in (then, now))
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    with np.errstate(invalid="ignore"):
        difference = np.abs(a - b)
    return np.where(same, 0.0, np.where(np.isnan(difference), np.inf, difference))


def _flat(values: np.ndarray[Any, Any]) -> Floats:
    return np.asarray(values, np.float64).reshape(len(values), math.prod(values.shape[1:]))
