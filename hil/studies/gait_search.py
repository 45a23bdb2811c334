"""`stride study gait`: what shapes a walk, or the gains of servos, found by CMA-ES."""

import sys
from collections.abc import Sequence
from functools import partial
from typing import Any, ClassVar, Literal, Protocol

import yaml
from pydantic import Field, PositiveFloat, PositiveInt

from hil.compose.optimisations import GainLimits, gait_objective, gait_space
from hil.description import RobotDescription
from hil.errors import InputError, StrideError, UnknownNameError
from hil.joint_gains import kind_of
from hil.robot_files import load_robot
from hil.studies.figures_gait_search import Move, draw_gait_search
from hil.studies.gain_runs import servo_limits
from hil.studies.gait_walks import GaitCase, gait_cost
from hil.studies.search.budget import SearchBudget
from hil.studies.search.cma_search import Search, SearchResult
from hil.studies.search.problem import SearchProblem
from hil.studies.search.space import SearchSpace
from hil.studies.study import Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import title

SpaceName = Literal["poses", "gait", "gains"]


class Space(Protocol):
    """Vectors of changes in spreads, and what they are in a robot file."""

    @property
    def variables(self) -> tuple[gait_space.Variable, ...]:
        """One an entry of a vector."""
        ...

    def bounds(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Least and largest entry of every variable."""
        ...

    def values(self, vector: Sequence[float]) -> dict[str, Any]:
        """By key, in the form of the robot file."""
        ...


class GaitStudy(Study):
    """Seed 003_73fecd8ec8927aad, section 6: the key points of a walk by CMA-ES.

    The cost is the mean over seeds and rates of `gait_objective`, its terms over those of the
    start. With pushes, walks are pushed harder and harder after the judged time, and what is
    missing of them counts.
    """

    name: ClassVar[str] = "gait"
    space: SpaceName
    vary: tuple[str, ...] = ()
    """Keys under `walking` in place of those of the space `gait`; some of the space `gains`."""
    rates_hz: tuple[PositiveInt, ...] = Field(min_length=1)
    seeds: tuple[int, ...] = Field(min_length=1)
    weights: dict[str, float]
    budget: SearchBudget
    sigma: PositiveFloat = 1.0
    """First standard deviation, in spreads of the variables."""
    warm_s: PositiveFloat
    judged_s: PositiveFloat
    pushes: int = Field(ge=0)
    speed_tolerance: PositiveFloat
    """Share of the commanded speed."""
    search_seed: int = Field(ge=0)

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk the start, search, and put the best beside it."""
        description = load_robot(self.request.robot, self.request.overrides)
        space = gait_space.GaitSpace(description, self._variables(description))
        return self._result(space, self._searched(space, run_cases))

    def _searched(self, space: Space, run_cases: RunCases) -> SearchResult:
        """The best that the search finds in a space, judged by the walk as it is now."""
        [start] = run_cases(gait_cost, [self._case((), {})])
        if "error" in start:
            raise InputError(f"study gait: the start cannot walk: {start['error']}")
        missing = [name for name in self.weights if name not in start]
        if missing:
            raise StrideError(f"study gait: the start walks too short to judge {missing[0]}")
        terms = {name: start[name] for name in self.weights}
        lower, upper = space.bounds()
        problem = SearchProblem(
            f"gait of {self.request.robot}",
            SearchSpace(
                names=tuple(variable.name for variable in space.variables),
                start=(0.0,) * len(space.variables),
                sigma=self.sigma,
                lower=lower,
                upper=upper,
            ),
            lambda vector: self._case(changes_of(space.values(vector)), terms),
            gait_cost,
        )
        return Search(problem, self.budget, self.search_seed).run(run_cases)

    def _case(self, changes: tuple[str, ...], start: dict[str, float]) -> GaitCase:
        return GaitCase(
            request=self.request,
            changes=changes,
            rates_hz=self.rates_hz,
            seeds=self.seeds,
            warm_s=self.warm_s,
            judged_s=self.judged_s,
            pushes=self.pushes,
            weights=self.weights,
            start=start,
            speed_tolerance=self.speed_tolerance,
        )

    def _variables(self, description: RobotDescription) -> list[gait_space.Variable]:
        if self.space == "poses":
            if description.actuation == "servo":
                raise InputError("--space poses: a servo robot has no key poses; use gait or gains")
            return gait_space.pose_variables(description)
        if self.space == "gains":
            if description.actuation == "torque":
                raise InputError("--space gains is for servo robots; torque robots: study gains")
            limits = _limits(description)
            return gait_space.gain_variables(description, self.rates_hz, limits, self.vary)
        if not self.vary and description.actuation == "torque":
            raise InputError("--space gait: say which numbers of a torque robot with --vary")
        return gait_space.gait_variables(description, self.vary or gait_space.SERVO_GAIT)

    def _result(self, space: Space, found: SearchResult) -> StudyResult:
        head = title(self.request, controller=False)
        rows: list[Result] = [
            {"iteration": iteration, "best_cost": cost}
            for iteration, cost in enumerate(found.history)
        ]
        moves = [
            Move(one.name, one.start, one.start + one.spread * change, change)
            for one, change in zip(space.variables, found.vector, strict=True)
        ]
        snippet = _snippet(space.values(found.vector), found)
        return StudyResult(
            rows,
            [_terms_table(head, found), _variables_table(moves)],
            partial(draw_gait_search, head, found.history, moves),
            notes=[f"ended after {found.iterations} iterations, {found.evaluations} candidates"],
            files={"best.yaml": snippet},
        )


def check_weights(weighting: str, texts: list[str] | None) -> dict[str, float]:
    """The weights of a weighting, some of them changed by `NAME=W`. Raises InputError."""
    if weighting not in gait_objective.WEIGHTINGS:
        raise UnknownNameError("--weighting", weighting, gait_objective.WEIGHTINGS)
    weights = dict(gait_objective.WEIGHTINGS[weighting])
    for text in texts or ():
        name, _, value = text.partition("=")
        if name not in gait_objective.TERMS:
            raise UnknownNameError("--weight", name, gait_objective.TERMS)
        try:
            weights[name] = float(value)
        except ValueError as error:
            raise InputError(f"--weight takes NAME=NUMBER, got {text!r}") from error
    return weights


def _limits(description: RobotDescription) -> dict[str, GainLimits]:
    """What the registers of each kind of joint can realise."""
    limits = servo_limits(description)
    for joint in description.joints:
        if kind_of(joint.name) not in limits:
            raise InputError(f"joint {joint.name}: {joint.servo} has no mode {joint.mode}")
    return limits


def changes_of(values: dict[str, Any]) -> tuple[str, ...]:
    """Values by key as `--set` takes them."""
    return tuple(f"{key}={value!r}" for key, value in values.items())


def _snippet(values: dict[str, Any], found: SearchResult) -> str:
    """The best values in the form of the robot file."""
    tree: dict[Any, Any] = {}
    for key, value in values.items():
        *sections, last = (int(part) if part.isdigit() else part for part in key.split("."))
        place = tree
        for section in sections:
            place = place.setdefault(section, {})
        place[last] = value
    return written_by(found) + yaml.safe_dump(tree, default_flow_style=None, sort_keys=False)


def written_by(found: SearchResult) -> str:
    """Comment lines of a file of results: the command, and what the search won."""
    command = " ".join(["stride", *sys.argv[1:]])
    return f"# {command}\n# cost {found.history[0]:.6g} at the start, {found.cost:.6g} here\n"


def _terms_table(head: str, found: SearchResult) -> Table:
    names = [name for name in found.start if name in found.result]
    lines = [(name, f"{found.start[name]:.4g}", f"{found.result[name]:.4g}") for name in names]
    return Table(f"{head}: cost and its terms, means over the walks", ("", "start", "best"), lines)


def _variables_table(moves: list[Move]) -> Table:
    lines = [(move.name, f"{move.start:.4g}", f"{move.best:.4g}") for move in moves]
    return Table("what was searched", ("", "start", "best"), lines)
