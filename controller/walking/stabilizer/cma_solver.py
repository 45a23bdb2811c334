"""The seed's solver: covariance matrix adaptation with few and small generations."""

from random import Random

from controller.walking.stabilizer.evaluation import ACCEPTED
from controller.walking.stabilizer.problem import Problem, Solution

POPULATION = 5
"""λ of the stored code: max(5, min(·, 3)) for three variables."""
SIGMA = 0.15
"""First standard deviation, in a box of width 1."""
GENERATIONS = 5
"""Seed 000_bd1305a0ae731442, section 5.1."""


class CmaSolver:
    """CMA-ES from the centre of the box, stopped at the first sample with f_eval < 1.

    `cma.purecma` needs 0.05 ms for a generation in three variables, the full `cma` 0.3 ms. Its
    draws come from a generator of our own, so that a run can be repeated.
    """

    def __init__(self, seed: int = 0) -> None:
        # Here, for it brings SciPy's statistics and Matplotlib: twice the start-up of all the rest.
        from cma import purecma

        self._search = purecma.CMAES
        self._normal = Random(seed).normalvariate

    def solve(self, problem: Problem) -> Solution:
        """See `Solver`."""
        search = self._search([0.5] * 3, SIGMA, POPULATION, randn=self._normal)
        for generation in range(1, GENERATIONS + 1):
            units = search.ask()
            values = []
            for unit in units:
                sample = problem.box.at([2.0 * u - 1.0 for u in unit])
                values.append(problem.total(sample))
                if values[-1] < ACCEPTED:
                    return Solution(sample, generation, limited=generation == GENERATIONS)
            if generation < GENERATIONS:
                search.tell(units, values)
        return Solution(None, GENERATIONS, limited=True)
