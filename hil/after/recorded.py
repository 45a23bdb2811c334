"""One recorded run with the robot that it was made with, and its part that is worth measuring."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats, Limit
from hil.recording import Recording, Rows, read_recording
from hil.robot_files import load_robot

TWIN = "twin"
"""Rung of a run whose goals were another one's."""
WARM_UP_S = 2.0
"""The first steps are not measured; of a short walk, its first quarter."""
LEAST_S = 1.0
"""A recording needs so much left."""


@dataclass(frozen=True)
class RecordedRun:
    """A run that was read back."""

    name: str
    recording: Recording
    description: RobotDescription

    @property
    def meta(self) -> dict[str, Any]:
        """As in meta.json."""
        return self.recording.meta

    @property
    def joints(self) -> list[str]:
        """Names, in the order of every array of shape (n,)."""
        names: list[str] = self.meta["joints"]
        return names

    @property
    def rate_hz(self) -> int:
        """Control rate [Hz]."""
        return int(self.meta["rate_hz"])

    @property
    def is_twin(self) -> bool:
        """Whether it is a replay: its body was carried, its feet stood on nothing."""
        return bool(self.meta["rung"] == TWIN)

    @cached_property
    def steady(self) -> Rows:
        """The ticks from which something is measured, one after the other.

        Of a walk those from the third second on; without one, all with torque on. Raises
        InputError where there are too few.
        """
        rows = self.recording.rows
        walking = rows["safety"]["walking"] & (rows["time_s"] >= 0)
        if np.count_nonzero(walking) >= LEAST_S * self.rate_hz:
            last = float(rows["time_s"][walking][-1])
            kept = walking & (rows["time_s"] >= min(WARM_UP_S, last / 4))
        else:
            kept = ((rows["applied"]["limit"] & int(Limit.HELD)) == 0).all(axis=1)
        places = np.flatnonzero(kept)
        if places.size < LEAST_S * self.rate_hz:
            raise InputError(
                f"{self.name}: {places.size} ticks with torque on are too few to measure anything"
            )
        chosen: Rows = rows[places[0] : places[-1] + 1]
        return chosen

    @cached_property
    def supply(self) -> Floats:
        """Mean measured supply of the steady ticks, over a tenth of a second [V], (T,)."""
        measured = self.steady["frame"]["joint_voltage"]
        known = np.isfinite(measured)
        sums = np.where(known, measured, 0.0).sum(axis=1)
        nominal = self.description.supply
        middle = nominal.voltage if nominal is not None else float("nan")
        counts = known.sum(axis=1)
        mean = np.divide(sums, counts, out=np.full(counts.size, middle), where=counts > 0)
        half = max(1, round(0.05 * self.rate_hz))
        padded = np.pad(mean, half, mode="edge")
        return np.convolve(padded, np.full(2 * half + 1, 1 / (2 * half + 1)), mode="valid")


def read_run(folder: Path, robot: str | None = None) -> RecordedRun:
    """A recorded run with its robot, or with another robot file. Raises InputError."""
    return run_of(folder.resolve().name, read_recording(folder), robot)


def run_of(name: str, recording: Recording, robot: str | None = None) -> RecordedRun:
    """A recording with its robot, or with another robot file. Raises InputError.

    The robot is that of the run's own request, `--set` changes included.
    """
    request = recording.meta["request"]
    overrides = tuple(request["overrides"]) if robot is None else ()
    description = load_robot(robot or request["robot"], overrides)
    if list(description.joint_names) != recording.meta["joints"]:
        raise InputError(
            f"{name}: {description.file} has other joints than the robot of the recording"
        )
    return RecordedRun(name, recording, description)
