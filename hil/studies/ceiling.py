"""`stride study ceiling`: how high gains may be at a rate, in closed form, and walks beside it."""

from functools import partial
from typing import ClassVar

from pydantic import Field, PositiveFloat, PositiveInt

from hil.description import RobotDescription
from hil.errors import StrideError
from hil.joint_gains import GainSet, set_for
from hil.robot_files import load_robot
from hil.studies.ceiling_rows import ALL, CeilingCase, ceiling_of
from hil.studies.figures_ceiling import draw_ceilings
from hil.studies.figures_gain_ceilings import draw_range_ceilings
from hil.studies.gain_sets import gain_overrides, scaled, stored_sets
from hil.studies.range_file import RateGains
from hil.studies.study import Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, title
from hil.studies.vibration import VibrationCase, vibration_of

BELOW, ABOVE = 0.9, 1.15
"""Shares of the least and of the typical ceiling at which walks are made."""


class CeilingStudy(Study):
    """h·λ_max(M⁻¹·D) ≤ 2 at every rate, for the set stored for it: whole, and joint by joint.

    A joint's factor is the largest on its own kp and kd, the others as stored. It depends on the
    pose: `factor` is that of the worst pose of a step, `factor_typical` the median over its poses,
    beyond which vibration has half of each step to grow. Walks just below and above show it.
    """

    name: ClassVar[str] = "ceiling"
    rates_hz: tuple[PositiveInt, ...] = Field(min_length=1)
    poses: PositiveInt
    walk_s: PositiveFloat
    """Length of the walk whose poses are taken, and of those that show the ceiling [s]."""
    check: bool
    """Walk below and above each ceiling (torque robots)."""

    ranges: tuple[RateGains, ...] = ()
    """Found by `stride study gains`: the largest sets are judged in place of the stored ones."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Ceilings of all rates, then the walks."""
        description = load_robot(self.request.robot, self.request.overrides)
        stored = stored_sets(description)
        sets = {rate: set_for(stored, rate) for rate in self.rates_hz}
        judged = {rate: stored[chosen] for rate, chosen in sets.items()}
        judged |= {found.rate_hz: found.largest for found in self.ranges}
        found = run_cases(ceiling_of, [self._case(rate, gains) for rate, gains in judged.items()])
        rows = []
        for (rate, chosen), result in zip(sets.items(), found, strict=True):
            if "error" in result:
                raise StrideError(f"the walk whose poses are taken: {result['error']}")
            where = {"rate_hz": rate, "gain_set": chosen}
            rows += [EMPTY | where | row for row in result["rows"]]
        if self.check and description.actuation == "torque":
            self._check(description, judged, rows, run_cases)
        head = title(self.request, controller=False)
        draw = partial(draw_ceilings, head, rows)
        if self.ranges:
            draw = partial(draw_range_ceilings, head, description, self.ranges, stored, rows)
        return StudyResult(rows, [_table(head, rows)], draw)

    def _case(self, rate_hz: int, gains: GainSet) -> CeilingCase:
        return CeilingCase(
            request=self.request.model_copy(update={"rate_hz": rate_hz}),
            gains=tuple((joint, *pair) for joint, pair in gains.items()),
            poses=self.poses,
            walk_s=self.walk_s,
        )

    def _check(
        self,
        description: RobotDescription,
        judged: dict[int, GainSet],
        rows: list[Result],
        run_cases: RunCases,
    ) -> None:
        """Walk at shares of every ceiling, and add how each walk went to its row."""
        bounded = [row for row in rows if row["factor_typical"] is not None]
        cases = []
        for row in bounded:
            gains = judged[row["rate_hz"]]
            joints = gains if row["joint_group"] == ALL else [row["joint_group"]]
            for factor in (BELOW * row["factor"], ABOVE * row["factor_typical"]):
                varied = scaled(gains, dict.fromkeys(joints, factor))
                changes = gain_overrides(description, row["gain_set"], varied)
                request = self.request.model_copy(
                    update={
                        "rate_hz": row["rate_hz"],
                        "pd": "explicit",
                        "duration_s": self.walk_s,
                        "overrides": (*self.request.overrides, *changes),
                    }
                )
                cases.append(VibrationCase(request=request))
        results = iter(run_cases(vibration_of, cases))
        for row in bounded:
            for where in ("below", "above"):
                row.update({f"{key}_{where}": value for key, value in next(results).items()})


EMPTY: Result = dict.fromkeys(
    (
        "rate_hz",
        "gain_set",
        "joint_group",
        "kp",
        "kd",
        "factor",
        "factor_typical",
        "kp_ceiling",
        "kd_ceiling",
        "kp_register",
        "kd_register",
        "vibration_below",
        "joint_below",
        "ending_below",
        "vibration_above",
        "joint_above",
        "ending_above",
    )
)
"""Columns of the CSV."""


def _table(head: str, rows: list[Result]) -> Table:
    """A line a rate and joint."""
    heads = (
        "Hz",
        "joint",
        "set",
        "kp",
        "kd",
        "factor",
        "typical",
        "kp ≤",
        "kd ≤",
        "below",
        "above",
    )
    lines = [
        (
            str(row["rate_hz"]),
            row["joint_group"],
            str(row["gain_set"]),
            *(number(row[key], ".3g") for key in ("kp", "kd", "factor", "factor_typical")),
            number(row["kp_ceiling"], ".3g"),
            number(row["kd_ceiling"], ".3g"),
            _walked(row, "below"),
            _walked(row, "above"),
        )
        for row in rows
    ]
    subject = (
        f"{head}: largest factor on gains, and vibration [rad/s] at {BELOW:g} and {ABOVE:g} of it"
    )
    return Table(subject, heads, lines)


def _walked(row: Result, where: str) -> str:
    if row[f"vibration_{where}"] is None:
        return row[f"ending_{where}"] or "–"
    ending = row[f"ending_{where}"]
    found = f"{row[f'vibration_{where}']:.2f} {row[f'joint_{where}']}"
    return found if ending is None else f"{found}, {ending}"
