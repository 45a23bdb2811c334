"""One tick's search: what a solver may ask, and what it answers."""

from dataclasses import dataclass
from typing import Protocol

from controller.walking.stabilizer.distribution import Distribution, distribution
from controller.walking.stabilizer.evaluation import Evaluation
from controller.walking.stabilizer.response import ResponseModel
from controller.walking.stabilizer.sample_box import Sample, SampleBox


@dataclass(slots=True)
class Problem:
    """Find a sample whose f_eval is below 1. Forces are front_left … rear_right and the toe [N]."""

    response: ResponseModel
    evaluation: Evaluation
    box: SampleBox
    initial: Distribution
    """Without extra torque."""
    flat: bool
    """Front and rear count."""
    offset: list[float]
    """What the load cells show beyond the model [N]."""
    evaluations: int = 0
    """Samples tried so far."""
    forces: list[float] | None = None
    """The model's forces for the last sample, without `offset`."""
    corrected: list[float] | None = None
    """The same with `offset`."""

    def total(self, sample: Sample) -> float:
        """f_eval of a sample."""
        self.evaluations += 1
        self.forces = forces = self.response.forces(sample)
        self.corrected = corrected(forces, self.offset)
        now = distribution(self.corrected)
        return self.evaluation.total(now, self.initial, self.flat)


@dataclass(frozen=True, slots=True)
class Solution:
    """What a solver found."""

    sample: Sample | None
    """Accepted torques; none if nothing was accepted."""
    iterations: int
    limited: bool
    """The search used up what it is allowed."""


class Solver(Protocol):
    """Searches the box of a problem."""

    def solve(self, problem: Problem) -> Solution:
        """The first sample accepted; its forces are then `problem.forces`."""
        ...


def corrected(forces: list[float], offset: list[float]) -> list[float]:
    """Predicted forces plus what the cells say beyond them; a floor never pulls."""
    return [max(a + b, 0.0) for a, b in zip(forces, offset, strict=True)]
