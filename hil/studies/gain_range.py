"""`stride study gains`: the range of acceptable gains at falling control rates."""

from functools import partial
from itertools import pairwise
from typing import Annotated, ClassVar

from pydantic import Field, PositiveFloat, PositiveInt

from hil.compose.optimisations import gain_space
from hil.description import RobotDescription
from hil.errors import InputError, UnknownNameError
from hil.joint_gains import GainSet
from hil.request import RunRequest
from hil.robot_facts import RobotFacts, robot_facts
from hil.robot_files import load_robot
from hil.studies.figures_gain_range import draw_gain_range
from hil.studies.gain_algorithm import lower_frequency
from hil.studies.gain_range_table import range_rows, range_table
from hil.studies.gain_runs import GainRuns, servo_limits
from hil.studies.gain_walks import GainCase, Similar, lateral_speed, legs, reference_walk
from hil.studies.search.budget import SearchBudget
from hil.studies.study import Result, RunCases, Study, StudyResult
from hil.studies.titles import title

CAP = 38.9
"""Largest ΣKp + 10·ΣKd of a torque robot over m·g·L: the first author's 25 000 N·m."""


class GainRangeStudy(Study):
    """Algorithm 1 of seed 000_bd1305a0ae731442: smallest and largest gains, rate by rate.

    The walk of the first rate with the first gains is the reference for all others.
    """

    name: ClassVar[str] = "gains"
    rates_hz: tuple[Annotated[PositiveInt, Field(le=2000)], ...] = Field(min_length=1)
    """Falling."""
    joints: tuple[str, ...] = ()
    """Kinds of joints whose gains vary; none for all."""
    budget: SearchBudget = SearchBudget()
    runs: PositiveInt = 10
    """Most runs of CMA for either end of a range."""
    eta: PositiveFloat = 0.05
    """Root mean square change of the gains below which runs are not repeated."""
    sigma: PositiveFloat = 0.05
    """First standard deviation, as a share of each gain."""
    warm_s: PositiveFloat
    """Time of the walk before it is judged [s]."""
    leg_s: PositiveFloat
    """Time of each of the three judged legs [s]."""
    seed: int = Field(default=0, ge=0)
    """Of the search."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk the reference, then lower the frequency."""
        description = load_robot(self.request.robot, self.request.overrides)
        start = self.start_gains()
        run_cma = self._runs(description, start, run_cases)
        rows: list[Result] = []
        for found in lower_frequency(start, self.rates_hz, run_cma, self.eta, self.runs):
            rows += range_rows(found, description)
            run_cases.publish(self._result(rows))
        return self._result(rows)

    def start_gains(self) -> GainSet:
        """The set that the robot has for the first rate; raises UnknownNameError for `joints`."""
        description = load_robot(self.request.robot, self.request.overrides)
        implicit = self.request.pd == "implicit"
        start = gain_space.gains_at(description, self.rates_hz[0], implicit)
        for joint in self.joints:
            if joint not in start:
                raise UnknownNameError("joint", joint, start)
        return start

    def _result(self, rows: list[Result]) -> StudyResult:
        head = ", ".join(filter(None, (title(self.request, controller=False), self._law)))
        return StudyResult(rows, [range_table(head, rows)], partial(draw_gain_range, head, rows))

    @property
    def _law(self) -> str | None:
        return f"{self.request.pd} PD" if self.request.pd else None

    def _runs(self, description: RobotDescription, start: GainSet, run_cases: RunCases) -> GainRuns:
        """The search of one rate and side, with the reference walk to compare with."""
        facts = robot_facts(description)
        request = self._request(self.rates_hz[0], facts)
        case = GainCase(request=request, gains=start, warm_s=self.warm_s, leg_s=self.leg_s)
        [found] = run_cases(reference_walk, [case])
        if "error" in found:
            raise InputError(f"study gains: the start set cannot walk: {found['error']}")
        if found["stopped_s"] is not None:
            raise InputError(
                f"study gains: the start set falls after {found['stopped_s']:.1f} s at "
                f"{self.rates_hz[0]} Hz: choose gains that walk there (walking.gain_rate)"
            )
        if abs(found["speed"] - found["wanted"]) > found["tolerance"]:
            raise InputError(
                f"study gains: the start set walks at {found['speed']:.2f} m/s in place of "
                f"{found['wanted']:g}: choose gains or a --speed that fit"
            )
        torque = description.actuation == "torque"
        return GainRuns(
            walk=case,
            joints=self.joints or tuple(start),
            similar=Similar.model_validate(found["similar"]),
            limits=servo_limits(description),
            cap=CAP * facts.weight * facts.leg_length if torque else None,
            budget=self.budget,
            sigma=self.sigma,
            seed=self.seed,
            run_cases=run_cases,
        )

    def _request(self, rate_hz: int, facts: RobotFacts) -> RunRequest:
        lateral = legs(self.warm_s, self.leg_s, lateral_speed(facts.speed_scale))
        schedules = self.request.schedules.model_copy(update={"lateral": lateral})
        return self.request.model_copy(update={"rate_hz": rate_hz, "schedules": schedules})


def check_rates(text: str) -> tuple[int, ...]:
    """Falling rates from `1000,750,…` [Hz]. Raises InputError."""
    try:
        rates = tuple(int(part) for part in text.split(","))
    except ValueError as error:
        raise InputError(f"--rates: {text!r} is not a list such as 1000,750,500") from error
    if any(after >= before for before, after in pairwise(rates)):
        raise InputError(f"--rates: must fall from each to the next (got {text})")
    return rates
