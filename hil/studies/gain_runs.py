"""One run of CMA of the gain study: from a start set to the best set near it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hil.compose import feasible_gains
from hil.compose.optimisations import GainLimits, gain_space
from hil.description import RobotDescription
from hil.joint_gains import GainSet, kind_of
from hil.studies.gain_algorithm import Run
from hil.studies.gain_walks import (
    CandidateCase,
    GainCase,
    Side,
    Similar,
    acceptable,
    evaluate_gains,
)
from hil.studies.search.budget import SearchBudget
from hil.studies.search.cma_search import Search
from hil.studies.search.problem import SearchProblem
from hil.studies.search.space import SearchSpace, Vector
from hil.studies.study import RunCases

FACTORS = (0.01, 10.0)
"""Least and largest gain of one run, as a factor on its start."""


def servo_limits(description: RobotDescription) -> dict[str, GainLimits]:
    """What the servos of every kind of joint can be asked for; of a torque robot nothing."""
    found: dict[str, GainLimits] = {}
    for joint in description.joints:
        region = feasible_gains(joint.servo, joint.mode) if joint.servo else None
        if region is not None:
            found[kind_of(joint.name)] = (region.stiffness, region.damping)
    return found


@dataclass(frozen=True, slots=True)
class GainRuns:
    """Implements `gain_algorithm.RunCma` by walks like that of `walk`."""

    walk: GainCase
    joints: tuple[str, ...]
    """Kinds of joints whose gains vary."""
    similar: Similar
    limits: Mapping[str, GainLimits]
    """Of the joints with servos."""
    cap: float | None
    """Largest ΣKp + 10·ΣKd, if there is one."""
    budget: SearchBudget
    sigma: float
    seed: int
    run_cases: RunCases

    def __call__(self, start: GainSet, rate_hz: int, side: Side, number: int) -> Run:
        """Search from a start set; `number` counts the runs of a rate and side from 0."""
        names = gain_space.variable_names(self.joints)
        ends = [end for joint in self.joints for end in self._ends(start[joint], joint)]
        low, high = zip(*ends, strict=True)
        space = SearchSpace(names, (1.0,) * len(names), self.sigma, low, high)

        def case(vector: Vector) -> CandidateCase:
            return CandidateCase(
                request=self.walk.request.model_copy(update={"rate_hz": rate_hz}),
                gains=gain_space.scaled(start, self.joints, vector),
                warm_s=self.walk.warm_s,
                leg_s=self.walk.leg_s,
                start=start,
                side=side,
                similar=self.similar,
                cap=self.cap,
            )

        title = f"{rate_hz} Hz, {side}, run {number + 1}"
        problem = SearchProblem(title, space, case, evaluate_gains)
        seed = np.random.SeedSequence([self.seed, rate_hz, side == "max", number])
        found = Search(problem, self.budget, int(seed.generate_state(1)[0])).run(self.run_cases)
        return Run(
            gain_space.scaled(start, self.joints, found.vector),
            acceptable(found.result),
            found.cost,
            found.iterations,
            found.evaluations,
            found.ended,
        )

    def _ends(self, pair: tuple[float, float], joint: str) -> list[tuple[float, float]]:
        """Least and largest factor on stiffness and damping of a kind of joint."""
        limits = self.limits.get(joint)
        if limits is None:
            return [FACTORS] * 2
        return [
            (max(FACTORS[0], low / gain), min(FACTORS[1], high / gain))
            for gain, (low, high) in zip(pair, limits, strict=True)
        ]
