"""`stride study turns`: turns while walking, by angle, control rate, turn rate and PD."""

from functools import partial
from typing import ClassVar

import numpy as np
from pydantic import Field, NonNegativeFloat, PositiveFloat, field_validator

from hil.interface import Floats, Ints
from hil.request import PdName
from hil.schedule import Point
from hil.studies.figures_turns import draw_turns
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, outcome, title
from hil.studies.walks import finite, walk
from hil.trace import Trace

RAMP_POINT_S = 0.02
"""A turn at a limited rate is asked for in small pieces, this far apart."""
REACHED = 0.95


class TurnCase(Case):
    """A walk with one turn."""

    angle_deg: float
    turn_rate: NonNegativeFloat
    """[rad/s]; 0 asks for the whole turn at once."""
    start_s: PositiveFloat
    duration_s: PositiveFloat


class TurnStudy(Study):
    """Turns from steady walking. Yaw is that of the root body.

    Time to 95 % counts from the command; overshoot is what the yaw, averaged over two steps,
    exceeds the angle by; the final error is that of the last two steps.
    """

    name: ClassVar[str] = "turns"
    angles_deg: tuple[float, ...] = Field(min_length=1)
    """Left positive."""
    turn_rates: tuple[NonNegativeFloat, ...] = Field(min_length=1)
    """[rad/s]; 0 asks for the whole turn at once."""
    rates_hz: tuple[int, ...] = Field(min_length=1)
    pds: tuple[PdName | None, ...] = Field(min_length=1)
    settle_s: PositiveFloat
    follow_s: PositiveFloat

    @field_validator("angles_deg")
    @classmethod
    def _turns(cls, angles: tuple[float, ...]) -> tuple[float, ...]:
        if 0.0 in angles:
            raise ValueError("a turn by 0 is none")
        return angles

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Turn by every angle, at every rate."""
        cases = [
            TurnCase(
                request=self.request.model_copy(update={"rate_hz": rate_hz, "pd": pd}),
                angle_deg=angle,
                turn_rate=turn_rate,
                start_s=self.settle_s,
                duration_s=self.settle_s + self.follow_s,
            )
            for rate_hz in self.rates_hz
            for pd in self.pds
            for turn_rate in self.turn_rates
            for angle in self.angles_deg
        ]
        rows = [
            EMPTY
            | {
                "rate_hz": case.request.rate_hz,
                "pd": case.request.pd,
                "turn_rate_radps": case.turn_rate,
                "angle_deg": case.angle_deg,
            }
            | result
            for case, result in zip(cases, run_cases(turn, cases), strict=True)
        ]
        head = title(self.request, controller=False)
        return StudyResult(rows, [_table(head, rows)], partial(draw_turns, head, rows))


EMPTY: Result = dict.fromkeys(
    (
        "rate_hz",
        "pd",
        "turn_rate_radps",
        "angle_deg",
        "time_to_95_s",
        "overshoot_pct",
        "final_error_deg",
        "ending",
        "stopped_s",
        "error",
    )
)
"""Columns of the CSV."""


def turn(case: TurnCase) -> Result:
    """How the yaw followed one turn."""
    schedules = case.request.schedules.model_copy(update={"turns": turn_points(case)})
    request = case.request.model_copy(
        update={"schedules": schedules, "duration_s": case.duration_s}
    )
    walked = walk(request)
    result: Result = {"ending": walked.ending, "stopped_s": walked.stopped_s}
    if walked.stopped_s is None:
        result |= turn_figures(walked.trace, np.radians(case.angle_deg), case.start_s)
    return result


def turn_points(case: TurnCase) -> tuple[Point, ...]:
    """The relative turns that add up to the angle at the asked rate [s, rad]."""
    angle = float(np.radians(case.angle_deg))
    pieces = 1
    if case.turn_rate > 0:
        pieces = max(1, round(abs(angle) / case.turn_rate / RAMP_POINT_S))
    return tuple((case.start_s + piece * RAMP_POINT_S, angle / pieces) for piece in range(pieces))


def turn_figures(trace: Trace, angle: float, start_s: float) -> Result:
    """Time to 95 % [s], overshoot [%] and final error [deg] of a turn by an angle [rad]."""
    after = trace.time_s >= start_s
    steps = trace.steps[after]
    turned = trace.yaw[after] - _over_a_stride(trace.yaw[~after], trace.steps[~after])[-1]
    share = turned / angle
    reached = np.flatnonzero(share >= REACHED)
    smooth = _over_a_stride(share, steps)
    last_two = steps >= steps[-1] - 2
    return {
        "time_to_95_s": float(reached[0] * (trace.time_s[1] - trace.time_s[0]))
        if len(reached)
        else None,
        "overshoot_pct": finite(100.0 * max(0.0, float(smooth.max()) - 1.0)),
        "final_error_deg": finite(np.degrees(turned[last_two].mean() - angle)),
    }


def _over_a_stride(values: Floats, steps: Ints) -> Floats:
    """Means over every two steps in a row: the pelvis yaws one way in one, back in the other."""
    counts = np.bincount(steps - steps[0])
    means = np.bincount(steps - steps[0], values) / counts
    return np.asarray((means[1:] + means[:-1]) / 2 if len(means) > 1 else means)


def _table(head: str, rows: list[Result]) -> Table:
    heads = ("rate Hz", "PD", "rad/s", "angle deg", "to 95 % s", "overshoot %", "final deg", "")
    lines = [
        (
            str(row["rate_hz"]),
            row["pd"] or "–",
            f"{row['turn_rate_radps']:g}" if row["turn_rate_radps"] else "at once",
            f"{row['angle_deg']:g}",
            *(
                number(row[key], ".2f")
                for key in ("time_to_95_s", "overshoot_pct", "final_error_deg")
            ),
            outcome(row),
        )
        for row in rows
    ]
    return Table(f"{head}: turns while walking", heads, lines)
