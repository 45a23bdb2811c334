"""`stride study speeds`: which speed is reached, over a grid of sagittal and coronal speeds."""

from functools import partial
from typing import ClassVar

from pydantic import Field, PositiveFloat, PositiveInt

from hil.request import RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies.figures_speeds import draw_speeds
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, outcome, title
from hil.studies.walks import Walk, finite, lasting, mean_velocity, walk

SAGITTAL_FROUDE = (-0.0662, 0.0, 0.0662, 0.1159, 0.1655, 0.2317, 0.2648, 0.3310)
"""−0.2 … 1.0 m/s of the 70.4 kg human (L = 0.93 m) as v/√(gL)."""
CORONAL_FROUDE = (0.0, 0.0662, -0.0662)
"""0, ±0.2 m/s of the same."""


class SpeedCase(Case):
    """A walk at a constant commanded velocity."""

    sagittal: float
    """[m/s]"""
    coronal: float
    """[m/s]"""
    steps: PositiveInt | None = None
    """Length of the walk; none: that of the request."""


class SpeedStudy(Study):
    """Walks at constant speeds. Reached speeds are means over whole strides, from 5 s on."""

    name: ClassVar[str] = "speeds"
    sagittal: tuple[float, ...] = Field(min_length=1)
    """[m/s]"""
    coronal: tuple[float, ...] = Field(min_length=1)
    """Left positive [m/s]."""
    duration_s: PositiveFloat
    steps: PositiveInt | None = None
    """Length of each walk in steps in place of the duration."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk every pair of speeds."""
        request = self.request.model_copy(update={"duration_s": self.duration_s})
        cases = [
            SpeedCase(request=request, sagittal=sagittal, coronal=coronal, steps=self.steps)
            for coronal in self.coronal
            for sagittal in self.sagittal
        ]
        rows = [
            {"target_mps": case.sagittal, "target_coronal_mps": case.coronal, **result}
            for case, result in zip(cases, run_cases(reach_speed, cases), strict=True)
        ]
        rows = [EMPTY | row for row in rows]
        draw = partial(draw_speeds, title(self.request), rows)
        return StudyResult(rows, [self._table(rows)], draw)

    def _table(self, rows: list[Result]) -> Table:
        heads = ("sagittal", "reached", "coronal", "reached", "steps", "disequil. %", "")
        lines = [
            (
                f"{row['target_mps']:.2f}",
                number(row["speed_mps"], ".3f"),
                f"{row['target_coronal_mps']:.2f}",
                number(row["coronal_mps"], ".3f"),
                str(row["steps"]),
                number(row["disequilibrium_pct"], ".1f"),
                outcome(row),
            )
            for row in rows
        ]
        length = f"{self.duration_s:g} s" if self.steps is None else f"{self.steps} steps"
        return Table(f"{title(self.request)}: {length} at each speed [m/s]", heads, lines)


EMPTY: Result = dict.fromkeys(
    (
        "target_mps",
        "target_coronal_mps",
        "speed_mps",
        "coronal_mps",
        "steps",
        "disequilibrium_pct",
        "ending",
        "stopped_s",
        "error",
    )
)
"""Columns of the CSV."""


def reach_speed(case: SpeedCase) -> Result:
    """Reached speeds, and whether the walk came to its end."""
    schedules = case.request.schedules.model_copy(
        update={"speed": ((0.0, case.sagittal),), "lateral": ((0.0, case.coronal),)}
    )
    asked = case.request.model_copy(update={"schedules": schedules})
    lasted = asked if case.steps is None else lasting(asked, case.steps)
    walked = lasted if isinstance(lasted, Walk) else walk(lasted)
    sagittal, coronal = mean_velocity(walked.trace)
    ended = walked.stopped_s is None
    return {
        "speed_mps": finite(sagittal) if ended else None,
        "coronal_mps": finite(coronal) if ended else None,
        "steps": walked.report["steps"],
        "disequilibrium_pct": walked.report["disequilibrium_pct"],
        "ending": walked.ending,
        "stopped_s": walked.stopped_s,
    }


def default_speeds(request: RunRequest) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Coronal and sagittal speeds of the human's grid, scaled to a robot by √(gL) [m/s]."""
    facts = robot_facts(load_robot(request.robot, request.overrides))
    coronal, sagittal = (
        tuple(round(froude * facts.speed_scale, 2) for froude in froudes)
        for froudes in (CORONAL_FROUDE, SAGITTAL_FROUDE)
    )
    return coronal, sagittal
