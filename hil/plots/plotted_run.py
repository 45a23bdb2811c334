"""What plots of a run are drawn from: the recording, its walk, and the robot that made it."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from hil.description import RobotDescription
from hil.interface import Floats
from hil.recording import Recording, Rows, read_recording
from hil.robot_files import load_robot
from hil.run_folder import read_json
from hil.trace import Trace

LAST_S = 4.0
"""Plots that show single steps show the end of the walk: there is what went wrong."""


@dataclass(frozen=True)
class PlottedRun:
    """A run to draw."""

    name: str
    recording: Recording
    description: RobotDescription
    report: dict[str, Any] | None
    """As in report.json; none of a run that was killed before it was written."""

    @property
    def faults(self) -> list[dict[str, Any]]:
        """What went wrong, as in report.json."""
        return [] if self.report is None else list(self.report["faults"])

    @property
    def meta(self) -> dict[str, Any]:
        """As in meta.json."""
        return self.recording.meta

    @property
    def rows(self) -> Rows:
        """Every recorded tick, start-up and way down included."""
        return self.recording.rows

    @property
    def time_s(self) -> Floats:
        """Of every recorded tick (T,)."""
        times: Floats = self.rows["time_s"]
        return times

    @property
    def joints(self) -> list[str]:
        """Names, in the order of every array of shape (n,)."""
        names: list[str] = self.meta["joints"]
        return names

    @cached_property
    def trace(self) -> Trace:
        """The walking ticks."""
        return self.recording.trace()

    @property
    def walked(self) -> bool:
        """Whether there is a walk to draw."""
        return len(self.trace) > 1

    @cached_property
    def last(self) -> Rows:
        """The last seconds of the walk; without one, of the recording."""
        rows = self.rows
        walking: Rows = rows[(rows["time_s"] >= 0) & rows["safety"]["walking"]]
        chosen = walking if len(walking) > 1 else rows
        kept: Rows = chosen[chosen["time_s"] >= chosen["time_s"][-1] - LAST_S]
        return kept


def plotted_run(folder: Path) -> PlottedRun:
    """Read a run folder for its plots. Raises InputError."""
    recording = read_recording(folder)
    request = recording.meta["request"]
    description = load_robot(request["robot"], tuple(request["overrides"]))
    file = folder / "report.json"
    report = read_json(file) if file.is_file() else None
    return PlottedRun(folder.resolve().name, recording, description, report)
