"""`stride study gait --space style`: a gait style for one speed and level of water, by CMA-ES."""

import math
from textwrap import wrap
from typing import Any, ClassVar

import numpy as np
from pydantic import Field, NonNegativeFloat, PositiveFloat

from hil.compose import build
from hil.compose.optimisations import style_space
from hil.errors import InputError
from hil.robot_files import load_robot
from hil.studies.gait_search import GaitStudy, SpaceName, changes_of, written_by
from hil.studies.gait_walks import GaitCase, gait_cost
from hil.studies.study import Case, Result, RunCases, StudyResult, Table
from hil.studies.swing_way import swing_way
from hil.studies.titles import number, outcome
from hil.studies.walks import walk_session
from hil.studies.water import WaterCase, reach_speed


class PresentCase(Case):
    """The walk at the cell with the styles that the robot has."""

    level: NonNegativeFloat
    """[m]"""


class StyleStudy(GaitStudy):
    """A reference controller for a speed and a level (seed 003_73fecd8ec8927aad, section 6).

    It starts from the present walk there: from its poses, from the way of its swing foot, and
    every candidate from the alteration Δ that it came to, so that a walk need not first find it,
    unless it falls with that Δ in its first steps.
    The best is accepted when it costs less than the present style and walks through a walk of full
    length, without that help, at its speed.
    """

    name: ClassVar[str] = "style"
    space: SpaceName = "poses"
    speed: float
    """[m/s]"""
    level: NonNegativeFloat
    """[m]"""
    held_s: PositiveFloat = 20.0
    """Length of the walk that the best must come through [s]."""
    present_s: PositiveFloat = 12.0
    """Length of the walk from which the search starts [s]."""
    alteration: float | None = Field(default=None, exclude=True)
    """Δ of the present walk [m], from its end; none before it."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk as now, search, walk the best to the end."""
        description = load_robot(self.request.robot, self.request.overrides)
        if description.actuation == "servo":
            raise InputError("--space style: a servo robot has no key poses; use gait or gains")
        request = self.request.model_copy(update={"duration_s": self.present_s})
        [present] = run_cases(present_walk, [PresentCase(request=request, level=self.level)])
        if present["ahead"] is None:
            raise InputError(f"study style: the present walk is too short: {present['ending']}")
        study = self.model_copy(update={"alteration": present["alteration"]})
        [judged] = run_cases(gait_cost, [study._case((), {})])
        if judged.get("fallen", 1):
            study = self
            [judged] = run_cases(gait_cost, [study._case((), {})])
        way = {"swing_ahead": np.array(present["ahead"]), "swing_aside": np.array(present["aside"])}
        space = style_space.StyleSpace(description, self.speed, self.level, way)
        found = study._searched(space, run_cases)
        style = space.style(found.vector)
        [now, best] = run_cases(
            reach_speed, [self._held(()), self._held(changes_of(space.values(found.vector)))]
        )
        result = self._result(space, found)
        result.tables.append(_held_table(self.held_s, (now, judged), (best, found.result)))
        accepted = found.cost < judged.get("cost", math.inf) and _walks(best)
        result.notes.append("accepted" if accepted else "not accepted: keep the present style")
        result.files["best.yaml"] = written_by(found) + style_text(style)
        return result

    def _case(self, changes: tuple[str, ...], start: dict[str, float]) -> GaitCase:
        if self.alteration is not None:
            changes = (f"walking.alteration.start={self.alteration!r}", *changes)
        return super()._case(changes, start)

    def _held(self, changes: tuple[str, ...]) -> WaterCase:
        overrides = (*self.request.overrides, *changes)
        request = self.request.model_copy(
            update={"duration_s": self.held_s, "overrides": overrides}
        )
        return WaterCase(
            request=request, speed=self.speed, level=self.level, density=1000.0, viscosity=1.0
        )


def style_text(style: dict[str, Any]) -> str:
    """An entry of `walking.references`, a line or two for each trajectory."""
    lines = [f"- speed: {style['speed']:g}", f"  water: {style['water']:g}", "  poses:"]
    for name, knots in style["poses"].items():
        pairs = ", ".join(f"[{phase:g},{value:g}]" for phase, value in knots)
        lines += wrap(f"{name}: [{pairs}]", 92, initial_indent=4 * " ", subsequent_indent=6 * " ")
    return "\n".join(lines) + "\n"


def present_walk(case: PresentCase) -> Result:
    """The swing foot's way at the key points' phases, and Δ at the end."""
    session = build(case.request)
    walked = walk_session(session)
    knots = style_space.WAY_KNOTS
    way = swing_way(
        session.description,
        walked.trace,
        np.array(knots["swing_ahead"]),
        np.array(knots["swing_aside"]),
    )
    ahead, aside = (None, None) if way is None else (part.tolist() for part in way)
    return {
        "ahead": ahead,
        "aside": aside,
        "alteration": session.controller.status.alteration,
        "ending": walked.ending,
    }


def _walks(held: Result) -> bool:
    """On its feet at the end, within 2 % of its speed."""
    error = held["error_pct"]
    return error is not None and abs(error) <= 2.0


def _held_table(seconds: float, now: tuple[Result, Result], best: tuple[Result, Result]) -> Table:
    lines = [
        (
            name,
            number(judged.get("cost"), ".4g"),
            number(row["speed_mps"], ".3f"),
            number(row["error_pct"], ".1f"),
            number(row["lift_m"], ".2f"),
            outcome(row),
        )
        for name, (row, judged) in (("present", now), ("best", best))
    ]
    heads = ("", "cost", "reached", "error %", "lift m", "")
    return Table(f"walks of {seconds:g} s", heads, lines)
