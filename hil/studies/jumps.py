"""`stride study jumps`: which targets are reached, by distance, side, height and airtime."""

import math
from functools import partial
from typing import ClassVar

from pydantic import Field, PositiveFloat

from hil.jump_order import JumpOrder
from hil.jump_report import KEYS
from hil.studies.figures_jumps import draw_jumps
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, title
from hil.studies.walks import walk

DURATION_S = 3.6
"""Windup, push, flight, landing, and more than a second of standing."""
LEAST_ERROR, ERROR_SHARE = 0.03, 0.05
"""A jump is on target within the larger of so many metres and that share of its distance."""
EMPTY: Result = dict.fromkeys(
    ("x_m", "y_m", "z_m", "airtime_asked_s", "feasible", "on_target", *KEYS, "error")
)
"""Columns of the CSV."""


class JumpCase(Case):
    """One jump."""

    order: JumpOrder


class JumpStudy(Study):
    """Jumps over a grid of targets and airtimes, each refused or done.

    A jump is on target if the feet's centre comes to rest within max(3 cm, 5 % of the distance)
    of it, level. Those that the actuators cannot do, or that have no room for a step, are told
    apart: shares are of the feasible ones.
    """

    name: ClassVar[str] = "jumps"
    forward: tuple[float, ...] = Field(min_length=1)
    """[m]"""
    lateral: tuple[float, ...] = Field(min_length=1)
    """Left positive [m]."""
    heights: tuple[float, ...] = Field(min_length=1)
    """Of the landing surface over the start [m]."""
    airtimes: tuple[PositiveFloat, ...] = Field(min_length=1)
    """[s]"""
    push_depth: PositiveFloat
    """[m]"""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Jump to every target in every airtime."""
        request = self.request.model_copy(update={"duration_s": DURATION_S})
        orders = [
            JumpOrder(target=(x, y, z), airtime=airtime, push_depth=self.push_depth)
            for z in self.heights
            for airtime in self.airtimes
            for y in self.lateral
            for x in self.forward
        ]
        cases = [JumpCase(request=request, order=order) for order in orders]
        rows = [
            _row(case.order, result)
            for case, result in zip(cases, run_cases(jump_once, cases), strict=True)
        ]
        draw = partial(draw_jumps, title(self.request), rows)
        return StudyResult(rows, [self._table(rows)], draw, [summary(rows)])

    def _table(self, rows: list[Result]) -> Table:
        heads = ("x", "y", "z", "airtime", "error mm", "apex mm", "take-off m/s", "torque", "")
        lines = [
            (
                f"{row['x_m']:.2f}",
                f"{row['y_m']:.2f}",
                f"{row['z_m']:.2f}",
                f"{row['airtime_asked_s']:.2f}",
                _millimetres(row["landing_error_m"]),
                _millimetres(row["apex_error_m"]),
                number(row["takeoff_velocity_error_mps"], ".2f"),
                number(row["peak_joint_torque_ratio"], ".2f"),
                verdict(row),
            )
            for row in rows
        ]
        return Table(f"{title(self.request)}: jumps [m, s]", heads, lines)


def jump_once(case: JumpCase) -> Result:
    """The report keys of one jump; a refused one raises StrideError."""
    jump = {"activity": "jump", "jump": case.order}
    jumped = walk(case.request.model_copy(update=jump))
    return {key: jumped.report[key] for key in KEYS}


def verdict(row: Result) -> str:
    """What became of a jump, in a word or two."""
    if not row["feasible"]:
        return "refused"
    if not row["landed_standing"]:
        return "fell"
    return "stands" if row["on_target"] else "stands, off target"


def summary(rows: list[Result]) -> str:
    """Shares of the feasible jumps that land standing and on target."""
    done = [row for row in rows if row["feasible"]]
    standing = sum(bool(row["landed_standing"]) for row in done)
    on_target = sum(bool(row["on_target"]) for row in done)
    refused = len(rows) - len(done)
    return (
        f"{len(done)} of {len(rows)} jumps are feasible ({refused} refused); of these {standing} "
        f"land standing, {on_target} of them within max(3 cm, 5 %)"
    )


def _row(order: JumpOrder, result: Result) -> Result:
    x, y, z = order.target
    row = EMPTY | {"x_m": x, "y_m": y, "z_m": z, "airtime_asked_s": order.airtime} | result
    row["feasible"] = row["error"] is None
    error = row["landing_error_m"]
    allowed = max(LEAST_ERROR, ERROR_SHARE * math.hypot(x, y))
    row["on_target"] = bool(row["landed_standing"]) and error is not None and error <= allowed
    return row


def _millimetres(value: float | None) -> str:
    return number(None if value is None else 1000.0 * value, ".0f")
