"""`stride study rates`: which control rates walk, straight, with the coronal cycle and pushed."""

from functools import partial
from typing import ClassVar, Literal

from pydantic import Field, PositiveFloat, PositiveInt

from hil.request import PdName, RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.schedule import Push
from hil.studies.coronal_cycle import FROUDE_SPEED, coronal_cycle
from hil.studies.figures_rates import draw_rates
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, outcome, title
from hil.studies.walks import PROBE_S, Walk, finite, lasting, mean_step_time, mean_velocity, walk

Scenario = Literal["straight", "cycle", "pushed"]
SCENARIOS: tuple[Scenario, ...] = ("straight", "cycle", "pushed")
RATES_HZ = (2000, 1000, 750, 500, 300, 250, 225, 150, 120, 100, 80, 60, 50, 40, 30)
PUSH_S = 0.3
LATERAL_FROUDE = 0.141
"""100 N for 0.3 s on the seeds' character as Δv/√(gL), their lateral push."""
BACKWARD_FROUDE = 0.212
"""150 N for 0.3 s, their backward push."""


class RateCase(Case):
    """A walk at one control rate."""

    scenario: Scenario
    mass: PositiveFloat
    """[kg]"""
    speed_scale: PositiveFloat
    """√(gL) [m/s]."""
    steps: PositiveInt | None = None
    """Length of the walk; none: that of the request."""


class RateStudy(Study):
    """The same walk at falling control rates.

    The scenarios: straight; sideways 0, +v, −v for five steps each, v/√(gL) = 0.066; straight
    with a push to the left at 40 % and one backward at 70 % of the time, Δv/√(gL) = 0.14 and
    0.21. A rate is as hard for a robot as its period is long: h·√(g/L).
    """

    name: ClassVar[str] = "rates"
    rates_hz: tuple[PositiveInt, ...] = Field(min_length=1)
    pds: tuple[PdName | None, ...] = Field(min_length=1)
    scenarios: tuple[Scenario, ...] = Field(min_length=1)
    duration_s: PositiveFloat
    steps: PositiveInt | None = None
    """Length of each walk in steps in place of the duration."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk every scenario at every rate, the costly high rates first."""
        facts = robot_facts(load_robot(self.request.robot, self.request.overrides))
        cases = [
            RateCase(
                request=self._request(rate_hz, pd),
                scenario=scenario,
                mass=facts.mass,
                speed_scale=facts.speed_scale,
                steps=self.steps,
            )
            for rate_hz in sorted(self.rates_hz, reverse=True)
            for pd in self.pds
            for scenario in self.scenarios
        ]
        rows = [
            EMPTY
            | {
                "rate_hz": case.request.rate_hz,
                "period_froude": 1.0 / (case.request.rate_hz or 1) / facts.time_scale,
                "pd": case.request.pd,
                "scenario": case.scenario,
            }
            | result
            for case, result in zip(cases, run_cases(walk_at_rate, cases), strict=True)
        ]
        head = title(self.request, controller=False)
        ends = [row["stopped_s"] for row in rows if row["stopped_s"] is not None]
        longest = self.duration_s if self.steps is None else 1.1 * max(ends, default=1.0)
        draw = partial(draw_rates, head, rows, longest, self._length)
        return StudyResult(rows, [self._table(head, rows)], draw)

    def _request(self, rate_hz: int, pd: PdName | None) -> RunRequest:
        return self.request.model_copy(
            update={"rate_hz": rate_hz, "pd": pd, "duration_s": self.duration_s}
        )

    @property
    def _length(self) -> str:
        return f"{self.duration_s:g} s" if self.steps is None else f"{self.steps} steps"

    def _table(self, head: str, rows: list[Result]) -> Table:
        """A line a rate, a column for each law and scenario: speed reached, or how it ended."""
        columns = [(pd, scenario) for pd in self.pds for scenario in self.scenarios]
        lines = []
        for rate_hz in dict.fromkeys(row["rate_hz"] for row in rows):
            of_rate = [row for row in rows if row["rate_hz"] == rate_hz]
            cells = {(row["pd"], row["scenario"]): _cell(row) for row in of_rate}
            period = f"{of_rate[0]['period_froude']:.4f}"
            lines.append((str(rate_hz), period, *(cells[column] for column in columns)))
        names = tuple(" ".join(filter(None, column)) for column in columns)
        subject = f"{head}: mean speed [m/s] of {self._length}, or how the walk ended"
        return Table(subject, ("rate Hz", "h·√(g/L)", *names), lines)


EMPTY: Result = dict.fromkeys(
    (
        "rate_hz",
        "period_froude",
        "pd",
        "scenario",
        "speed_mps",
        "target_mps",
        "steps",
        "disequilibrium_pct",
        "ending",
        "stopped_s",
        "error",
    )
)
"""Columns of the CSV."""


def walk_at_rate(case: RateCase) -> Result:
    """One scenario at one rate."""
    walked = walk_scenario(case)
    speed, _ = mean_velocity(walked.trace)
    return {
        "speed_mps": finite(speed),
        "target_mps": walked.report["target_speed_mps"],
        "steps": walked.report["steps"],
        "disequilibrium_pct": walked.report["disequilibrium_pct"],
        "ending": walked.ending,
        "stopped_s": walked.stopped_s,
    }


def walk_scenario(case: RateCase) -> Walk:
    """The walk of a scenario; if its steps must be timed first and that falls, the fallen one."""
    request = case.request
    if case.steps is not None:
        longer = lasting(request, case.steps)
        if isinstance(longer, Walk):
            return longer
        request = longer
    schedules = request.schedules
    if case.scenario == "cycle":
        probe = walk(request.model_copy(update={"duration_s": min(PROBE_S, request.duration_s)}))
        if probe.stopped_s is not None:
            return probe
        amplitude = FROUDE_SPEED * case.speed_scale
        points = coronal_cycle(amplitude, mean_step_time(probe.trace), request.duration_s)
        schedules = schedules.model_copy(update={"lateral": points})
    if case.scenario == "pushed":
        pushes = seed_pushes(case, request.duration_s)
        schedules = schedules.model_copy(update={"pushes": pushes})
    return walk(request.model_copy(update={"schedules": schedules}))


def seed_pushes(case: RateCase, duration_s: float) -> tuple[Push, Push]:
    """One push to the left, and later one backward, in a walk of so many seconds."""
    force = case.mass * case.speed_scale / PUSH_S
    return (
        Push(force=(0.0, LATERAL_FROUDE * force, 0.0), start=0.4 * duration_s, duration=PUSH_S),
        Push(force=(-BACKWARD_FROUDE * force, 0.0, 0.0), start=0.7 * duration_s, duration=PUSH_S),
    )


def _cell(row: Result) -> str:
    if row["error"] or row["ending"]:
        return outcome(row)
    return number(row["speed_mps"], ".3f")
