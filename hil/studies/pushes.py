"""`stride study pushes`: the largest push that is survived, by direction and phase."""

import math
from functools import partial
from typing import ClassVar

from pydantic import Field, PositiveFloat

from hil.errors import InputError, StrideError, UnknownNameError
from hil.request import RunRequest
from hil.robot_facts import RobotFacts, robot_facts
from hil.robot_files import load_robot
from hil.schedule import Push
from hil.studies.figures_pushes import draw_pushes
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import title
from hil.studies.walks import step_starts, walk

DIAGONAL = math.sqrt(0.5)
DIRECTIONS = {
    "forward": (1.0, 0.0),
    "forward_left": (DIAGONAL, DIAGONAL),
    "left": (0.0, 1.0),
    "back_left": (-DIAGONAL, DIAGONAL),
    "back": (-1.0, 0.0),
    "back_right": (-DIAGONAL, -DIAGONAL),
    "right": (0.0, -1.0),
    "forward_right": (DIAGONAL, -DIAGONAL),
}
"""Unit vectors in the world; the robot walks along x."""
CARDINAL = ("forward", "left", "back", "right")
FROUDE_STEP = 0.07
"""Step of the default ladder as Δv/√(gL): 50 N on the 70.4 kg human."""
FROUDE_MAX = 0.42


class PhaseCase(Case):
    """The unperturbed walk, which says when steps begin."""

    settle_s: PositiveFloat
    duration_s: PositiveFloat


class PushCase(Case):
    """A ladder of pushes of one direction that begin at one time."""

    direction: tuple[float, float]
    start_s: PositiveFloat
    duration_s: PositiveFloat
    follow_s: PositiveFloat
    forces: tuple[PositiveFloat, ...]
    """Rising [N]."""


class PushStudy(Study):
    """Pushes at the centre of mass of the root body, at phases spread over two steps.

    Forces rise until the robot falls for the first time, so a force counts as survived only with
    all smaller ones of the ladder. Δv = F·Δt/m compares robots as Δv/√(gL).
    """

    name: ClassVar[str] = "pushes"
    directions: tuple[str, ...] = Field(min_length=1)
    phases: int = Field(ge=1)
    """Equally spaced over two steps from the start of a step on the left foot."""
    forces: tuple[PositiveFloat, ...] = Field(min_length=1)
    """Rising [N]."""
    push_s: PositiveFloat
    """[s]"""
    settle_s: PositiveFloat
    """Walking time before the first phase [s]."""
    follow_s: PositiveFloat
    """Walking time after the push [s]."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Time the steps of the unperturbed walk, push at its phases, tabulate."""
        starts = self._starts(run_cases)
        grid = [(name, phase) for name in self.directions for phase in range(self.phases)]
        cases = [
            PushCase(
                request=self.request,
                direction=DIRECTIONS[name],
                start_s=starts[phase],
                duration_s=self.push_s,
                follow_s=self.follow_s,
                forces=self.forces,
            )
            for name, phase in grid
        ]
        facts = robot_facts(load_robot(self.request.robot, self.request.overrides))
        rows = [
            self._row(facts, name, phase, starts[phase], result)
            for (name, phase), result in zip(grid, run_cases(push_ladder, cases), strict=True)
        ]
        scale = self.push_s / facts.mass / facts.speed_scale
        draw = partial(draw_pushes, title(self.request), rows, self.forces[-1], scale)
        return StudyResult(rows, [self._table(rows, scale)], draw)

    def _starts(self, run_cases: RunCases) -> list[float]:
        probe = PhaseCase(
            request=self.request, settle_s=self.settle_s, duration_s=self.settle_s + 4.0
        )
        result = run_cases(time_two_steps, [probe])[0]
        if "error" in result:
            raise StrideError(f"the walk before the push: {result['error']}")
        begin, end = result["begin_s"], result["end_s"]
        return [begin + (end - begin) * phase / self.phases for phase in range(self.phases)]

    def _row(
        self, facts: RobotFacts, name: str, phase: int, start_s: float, result: Result
    ) -> Result:
        survived = result.get("survived_n")
        delta_v = None if survived is None else survived * self.push_s / facts.mass
        return {
            "direction": name,
            "phase": 2.0 * phase / self.phases,
            "start_s": start_s,
            "survived_n": survived,
            "fell_at_n": result.get("fell_at_n"),
            "delta_v_mps": delta_v,
            "delta_v_froude": None if delta_v is None else delta_v / facts.speed_scale,
            "error": result.get("error"),
        }

    def _table(self, rows: list[Result], scale: float) -> Table:
        """Largest survived force by direction and phase; at all phases, also as Δv/√(gL)."""
        phases = tuple(f"{2.0 * phase / self.phases:.2f}" for phase in range(self.phases))
        lines = []
        for name in self.directions:
            forces = [row["survived_n"] for row in rows if row["direction"] == name]
            cells = tuple("error" if force is None else f"{force:g}" for force in forces)
            least = min((force or 0.0) for force in forces)
            lines.append((name, *cells, f"{least:g}", f"{least * scale:.3f}"))
        return Table(
            f"{title(self.request)}: largest survived push of {self.push_s:g} s [N], by phase "
            f"[steps]; ladder {self.forces[0]:g} … {self.forces[-1]:g} N",
            ("", *phases, "all phases", "Δv/√(gL)"),
            lines,
        )


def time_two_steps(case: PhaseCase) -> Result:
    """Begin and end of the first two steps after settling that begin on the left foot [s]."""
    walked = walk(case.request.model_copy(update={"duration_s": case.duration_s}))
    if walked.stopped_s is not None:
        raise StrideError(f"{walked.ending} at {walked.stopped_s:.2f} s, unperturbed")
    times, stance = step_starts(walked.trace)
    for index in range(len(times) - 2):
        if times[index] >= case.settle_s and stance[index] == 0:
            return {"begin_s": float(times[index]), "end_s": float(times[index + 2])}
    raise StrideError(f"too few steps in {case.duration_s:g} s to push at their phases")


def push_ladder(case: PushCase) -> Result:
    """The largest force survived on the way up, and the one that felled the robot, if any."""
    survived = 0.0
    for force in case.forces:
        if not _survives(case, force):
            return {"survived_n": survived, "fell_at_n": force}
        survived = force
    return {"survived_n": survived, "fell_at_n": None}


def ladder(
    request: RunRequest, step_n: float | None, max_n: float | None, push_s: float
) -> tuple[float, ...]:
    """Forces step, 2·step, … up to the largest [N]; by default scaled to the robot.

    Raises InputError for a step beyond the largest force.
    """
    facts = robot_facts(load_robot(request.robot, request.overrides))
    per_froude = facts.mass * facts.speed_scale / push_s
    step = step_n or float(f"{FROUDE_STEP * per_froude:.2g}")
    largest = max_n or max(step, 1.01 * FROUDE_MAX * per_froude)
    count = math.floor(largest / step + 1e-6)
    if count < 1:
        raise InputError(f"--force-step: {step:g} N is beyond --force-max {largest:g} N")
    return tuple(round(step * rung, 6) for rung in range(1, count + 1))


def check_directions(names: list[str]) -> tuple[str, ...]:
    """The directions as asked for, or UnknownNameError."""
    for name in names:
        if name not in DIRECTIONS:
            raise UnknownNameError("--direction", name, DIRECTIONS)
    return tuple(dict.fromkeys(names))


def _survives(case: PushCase, force: float) -> bool:
    x, y = case.direction
    push = Push(force=(force * x, force * y, 0.0), start=case.start_s, duration=case.duration_s)
    schedules = case.request.schedules.model_copy(update={"pushes": (push,)})
    end_s = case.start_s + case.duration_s + case.follow_s
    request = case.request.model_copy(update={"schedules": schedules, "duration_s": end_s})
    return walk(request).stopped_s is None
