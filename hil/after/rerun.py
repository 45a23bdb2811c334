"""`stride replay`: the controller again, on the frames that a run recorded."""

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from hil.after.recorded import TWIN
from hil.after.rerun_differences import Difference, find_differences
from hil.after.ticks import recorded_ticks
from hil.compose import RerunParts, build_rerun
from hil.cycle import TickRecord
from hil.errors import InputError
from hil.interface import Bools
from hil.record_layout import TickWriter, tick_dtype
from hil.recording import Recording, Rows
from hil.request import RunRequest
from hil.robot_files import load_robot


@dataclass(frozen=True, slots=True)
class Rerun:
    """What came of running a controller again."""

    ticks: int
    """Recorded ticks, start-up included."""
    commands: int
    """Ticks in which the controller was asked for a command."""
    estimated: bool
    """Whether the estimator ran too; else the controller was given the recorded estimates."""
    gaps: int
    """Ticks that the recording lacks: missed by the run, or dropped by its recorder."""
    raised: str | None
    """What the controller or the estimator raised, and when; none: nothing."""
    raised_then: bool
    """Whether the run's controller raised in that tick too."""
    mended: bool
    """The run's controller raised in some tick, and this one in none."""
    differences: list[Difference]
    """The earliest first."""

    @property
    def identical(self) -> bool:
        """Whether estimates, commands and status are those of the run, to the last bit or to the
        tolerance that was given.
        """
        return not (self.differences or self.mended) and (self.raised is None or self.raised_then)

    def as_dict(self) -> dict[str, Any]:
        """For `--json`; a difference that is not finite is null."""
        data = asdict(self) | {"identical": self.identical}
        for one in data["differences"]:
            one["largest"] = one["largest"] if math.isfinite(one["largest"]) else None
        return data


def rerun_parts(recording: Recording, name: str, overrides: tuple[str, ...] = ()) -> RerunParts:
    """Estimator and controller of a run, from its own request and `--set` changes after it.

    Raises InputError for a run that no controller made, and for changes that do not fit.
    """
    meta = recording.meta
    if meta["rung"] == TWIN:
        raise InputError(f"{name}: is a twin: no controller made it; replay the run it is of")
    recorded = RunRequest.checked(**meta["request"])
    request = recorded.model_copy(update={"overrides": (*recorded.overrides, *overrides)})
    description = load_robot(request.robot, request.overrides)
    if list(description.joint_names) != meta["joints"]:
        raise InputError(f"{description.file}: has other joints than the robot of {name}")
    return build_rerun(request, description)


def rerun(recording: Recording, parts: RerunParts, tolerance: float = 0.0) -> Rerun:
    """Give every recorded frame to an estimator and a controller that begin anew.

    The estimator hears every tick, as it did; the controller is asked in the ticks in which the
    run asked it: from T = 0 until the way down began. What start-up sent came from no controller.
    `tolerance`: a difference larger than this is told, in SI units.
    """
    rows = recording.rows
    again: Rows = np.zeros(len(rows), tick_dtype(len(recording.meta["joints"]), truth=False))
    asked, unsure = _asked(rows)
    player = _Player(parts, TickWriter(again))
    done, raised = len(rows), None
    for index, record in enumerate(recorded_ticks(recording)):
        try:
            player.play(index, record, bool(asked[index]))
        except Exception as error:  # whatever it is, it is what the user wants to know
            done = index
            raised = f"{type(error).__name__}: {error} (t = {record.time_s:.3f} s)"
            break
    compared = asked[:done] & ~unsure[:done]
    estimated = parts.estimator is not None
    everywhere = np.full(done, estimated)
    found = find_differences(rows[:done], again[:done], everywhere, compared, recording.meta,
                             tolerance)  # fmt: skip
    ticks = rows["timing"]["tick"]
    gaps = int(np.maximum(np.diff(ticks) - 1, 0).sum())
    raised_then = raised is not None and bool(unsure[done])
    mended = raised is None and bool(unsure.any())
    commands = int(asked[:done].sum())
    return Rerun(len(rows), commands, estimated, gaps, raised, raised_then, mended, found)


def _asked(rows: Rows) -> tuple[Bools, Bools]:
    """Ticks in which the run's controller was asked, and those of them in which it raised.

    The controller's time is 0 where it raised, and in a last tick that the supervisor ended
    before anybody was asked.
    """
    walking: Bools = (rows["time_s"] >= 0) & rows["safety"]["walking"]
    silent: Bools = walking & (rows["timing"]["control_ns"] == 0)
    if len(rows) and silent[-1]:
        walking[-1] = silent[-1] = False
    return walking, silent


class _Player:
    """Runs the parts on one tick after the other, and writes what they say."""

    def __init__(self, parts: RerunParts, writer: TickWriter) -> None:
        self._parts, self._writer = parts, writer

    def play(self, index: int, record: TickRecord, asked: bool) -> None:
        """One tick."""
        estimator, controller = self._parts.estimator, self._parts.controller
        estimate = record.estimate if estimator is None else estimator.update(record.frame)
        command = controller.step(estimate, record.reference) if asked else record.command
        said = replace(record, estimate=estimate, command=command, status=controller.status)
        self._writer.write(index, said)
