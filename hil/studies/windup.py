"""`stride study windup`: what constants, muscles, limits and the character do to a windup."""

from functools import partial
from typing import ClassVar, Literal

from pydantic import PositiveFloat

from hil.robot_files import load_robot
from hil.studies.figures_windup import draw_windup
from hil.studies.study import Result, RunCases, Study, StudyResult
from hil.studies.windup_case import WindupCase, windup_of
from hil.studies.windup_rows import (
    Labelled,
    character_cases,
    gain_cases,
    limit_cases,
    muscle_cases,
)
from hil.studies.windup_tables import windup_tables

SEPARATE = ("figure", "bvh", "csv")
"""What a row of the CSV has no room for."""


class WindupStudy(Study):
    """Windups of one jump, of which one thing at a time is varied.

    Nothing moves and nothing falls: it is geometry. Pictures and tables of chapter 3 of seed
    004_2880d7939e94ed85, of which the seed left the tables empty.
    """

    name: ClassVar[str] = "windup"
    displacement: tuple[float, float, float]
    airtime: PositiveFloat
    push_depth: PositiveFloat
    gravity: PositiveFloat
    law: Literal["mitre", "chord"]
    few: bool = False
    """One or two of each kind: does it run at all?"""

    @property
    def base(self) -> WindupCase:
        """The windup of which everything else is a variation."""
        return WindupCase(
            request=self.request,
            displacement=self.displacement,
            airtime=self.airtime,
            push_depth=self.push_depth,
            gravity=self.gravity,
            law=self.law,
            key_frames=True,
        )

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Wind up plainly, then in every variation."""
        description = load_robot(self.request.robot, self.request.overrides)
        plain = windup_of(self.base)
        base = self.base.model_copy(update={"key_frames": False})
        labelled: list[Labelled] = [
            *gain_cases(base, few=self.few),
            *muscle_cases(base, few=self.few),
            *limit_cases(base, description, few=self.few),
            *character_cases(base, few=self.few),
        ]
        results = run_cases(windup_of, [case for _, case in labelled])
        rows = [{"table": "plain", "law": self.law} | plain]
        rows += [labels | result for (labels, _), result in zip(labelled, results, strict=True)]
        head = f"{description.name}, {_jump(self)}, {self.law} muscles"
        return StudyResult(
            [_flat(rows, row) for row in rows],
            windup_tables(head, rows),
            partial(draw_windup, head, description, rows),
            files={
                "windup.bvh": plain["bvh"],
                "windup_key_frames.csv": plain["csv"],
            },
        )


def _jump(study: WindupStudy) -> str:
    x, y, z = study.displacement
    return (
        f"jump of ({x:.3g}, {y:.3g}, {z:.3g}) m in {study.airtime:.3g} s, "
        f"push over {study.push_depth:.3g} m, g = {study.gravity:g} m/s²"
    )


def _flat(rows: list[Result], row: Result) -> Result:
    """A row of the CSV, with the columns that any row has."""
    names = dict.fromkeys(name for each in rows for name in each if name not in SEPARATE)
    return {name: row.get(name) for name in names}
