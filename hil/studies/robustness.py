"""`stride study robustness`: which robots walk in which conditions, and what fells the others."""

from functools import partial
from typing import ClassVar

from pydantic import Field, PositiveFloat, PositiveInt

from hil.errors import InputError, UnknownNameError
from hil.request import RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies import hidden_draws
from hil.studies.conditions import CONDITIONS, Condition
from hil.studies.figures_robustness import draw_robustness
from hil.studies.robust_tables import blame_table, conditions_table, ends_table
from hil.studies.robust_walks import EMPTY, PushedCase, RobustCase, robust_pushes, robust_walk
from hil.studies.study import Result, RunCases, Study, StudyResult
from hil.studies.titles import title

PUSH_S = 0.3
SETTLE_S = 3.0
"""Walking time before the first phase of a push [s]."""
FOLLOW_S = 4.0
"""Walking time after it [s]."""
ENDS_CONDITIONS = ("baseline", "forward")
"""Conditions in which every hidden quantity is put to the ends of its range."""


class RobustnessStudy(Study):
    """Every condition at every rate on every robot; a seed draws what a robot hides.

    Then, for each walk that fell, which hidden quantity did it: the walk again with one quantity
    nominal, and with only one drawn. And every quantity alone, for all joints, at both ends of its
    range. A push condition is survived when every direction at every phase is.
    """

    name: ClassVar[str] = "robustness"
    conditions: tuple[str, ...] = Field(min_length=1)
    rates_hz: tuple[PositiveInt, ...] = Field(min_length=1)
    seeds: tuple[int, ...] = Field(min_length=1)
    phases: PositiveInt
    """Of each push, over two steps."""
    longest_s: PositiveFloat | None
    """No walk takes longer than this [s]; none: as long as its condition says."""
    blame: bool
    """Look for the draw that fells."""
    ends: bool
    """Put every drawn quantity to the ends of its range."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """All walks, then those that explain the falls."""
        rows = self._walks(run_cases) + self._pushes(run_cases)
        rows.sort(key=lambda row: self.conditions.index(row["condition"]))
        tables = [conditions_table(title(self.request, controller=False), rows)]
        ranges = hidden_draws.drawn(load_robot(self.request.robot, self.request.overrides))
        if self.blame and ranges:
            tables.append(blame_table(self._blame(run_cases, rows, ranges)))
        if self.ends and ranges:
            tables.append(ends_table(self._ends(run_cases, ranges)))
        head = title(self.request, controller=False)
        return StudyResult(rows, tables, partial(draw_robustness, head, rows))

    def _walks(self, run_cases: RunCases) -> list[Result]:
        grid = [place for place in self._grid() if not CONDITIONS[place[0]].pushes]
        cases = [self._case(*place) for place in grid]
        return _rows(grid, run_cases(robust_walk, cases))

    def _pushes(self, run_cases: RunCases) -> list[Result]:
        grid = [place for place in self._grid() if CONDITIONS[place[0]].pushes]
        facts = robot_facts(load_robot(self.request.robot, self.request.overrides))
        per_froude = facts.mass * facts.speed_scale / PUSH_S
        cases = [
            PushedCase(
                request=self._request(*place),
                directions=CONDITIONS[place[0]].pushes,
                force=CONDITIONS[place[0]].push_froude * per_froude,
                push_s=PUSH_S,
                phases=self.phases,
                settle_s=SETTLE_S,
                follow_s=FOLLOW_S,
            )
            for place in grid
        ]
        return _rows(grid, run_cases(robust_pushes, cases))

    def _blame(
        self, run_cases: RunCases, rows: list[Result], ranges: dict[str, tuple[float, float]]
    ) -> list[Result]:
        """For every fallen walk and drawn quantity: is it saved without, does it fall with only."""
        fallen = [
            (row["condition"], row["rate_hz"], row["seed"])
            for row in rows
            if row["survived"] is False and row["pushes"] is None
        ]
        grid = [(place, name) for place in fallen for name in ranges]
        changes = [
            change(ranges, name)
            for _, name in grid
            for change in (hidden_draws.without, hidden_draws.only)
        ]
        places = [place for place, _ in grid for _ in range(2)]
        results = run_cases(
            robust_walk,
            [self._case(*place, (text,)) for place, text in zip(places, changes, strict=True)],
        )
        return [
            {
                "condition": place[0],
                "draw": name,
                "saved_without": results[2 * index].get("survived"),
                "felled_alone": results[2 * index + 1].get("survived") is False,
            }
            for index, (place, name) in enumerate(grid)
        ]

    def _ends(self, run_cases: RunCases, ranges: dict[str, tuple[float, float]]) -> list[Result]:
        grid = [
            (condition, rate_hz, name, value)
            for condition in ENDS_CONDITIONS
            for rate_hz in self.rates_hz
            for name, limits in ranges.items()
            for value in limits
        ]
        cases = [
            self._case(condition, rate_hz, self.seeds[0], hidden_draws.at_end(name, value))
            for condition, rate_hz, name, value in grid
        ]
        return [
            {"condition": condition, "rate_hz": rate_hz, "draw": name, "value": value, **result}
            for (condition, rate_hz, name, value), result in zip(
                grid, run_cases(robust_walk, cases), strict=True
            )
        ]

    def _grid(self) -> list[tuple[str, int, int]]:
        return [
            (name, rate_hz, seed)
            for name in self.conditions
            for rate_hz in self.rates_hz
            for seed in self.seeds
        ]

    def _case(
        self, name: str, rate_hz: int, seed: int, changes: tuple[str, ...] = ()
    ) -> RobustCase:
        return RobustCase(request=self._request(name, rate_hz, seed, changes))

    def _request(
        self, name: str, rate_hz: int, seed: int, changes: tuple[str, ...] = ()
    ) -> RunRequest:
        condition: Condition = CONDITIONS[name]
        time_s = condition.time_s
        update = {
            "rate_hz": rate_hz,
            "seed": seed,
            "schedules": condition.schedules,
            "duration_s": time_s if self.longest_s is None else min(time_s, self.longest_s),
            "overrides": (*self.request.overrides, *condition.overrides, *changes),
        }
        return self.request.model_copy(update=update)


def check_conditions(names: list[str]) -> tuple[str, ...]:
    """The conditions as asked for, or UnknownNameError."""
    for name in names:
        if name not in CONDITIONS:
            raise UnknownNameError("--condition", name, CONDITIONS)
    return tuple(dict.fromkeys(names))


def require_servos(request: RunRequest) -> None:
    """Raise InputError for a robot that the conditions are not made for."""
    description = load_robot(request.robot, request.overrides)
    if description.actuation != "servo":
        raise InputError(
            f"study robustness: its conditions are those of a servo robot; {description.name} "
            "takes torques"
        )


def _rows(grid: list[tuple[str, int, int]], results: list[Result]) -> list[Result]:
    return [
        EMPTY | {"condition": name, "rate_hz": rate_hz, "seed": seed} | result
        for (name, rate_hz, seed), result in zip(grid, results, strict=True)
    ]
