"""CMA-ES over the cases of a study."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import cma
import numpy as np

from hil.errors import StrideError
from hil.interface import Floats
from hil.studies.search.budget import SearchBudget
from hil.studies.search.problem import SearchProblem
from hil.studies.search.progress import SearchProgress
from hil.studies.search.space import SearchSpace, Vector
from hil.studies.study import CaseT, Result, RunCases

Ending = Literal["iterations", "still", "converged"]


@dataclass(frozen=True, slots=True)
class SearchResult:
    """The best of all candidates that were tried, the start among them."""

    vector: Vector
    cost: float
    result: Result
    """What `evaluate` returned for it."""
    start: Result
    """The same for the start."""
    iterations: int
    evaluations: int
    history: tuple[float, ...]
    """Lowest cost so far, of the start and after every iteration."""
    ended: Ending
    """The limit of iterations, no more evolution, or CMA's own tests."""


class Search:
    """Minimises a problem with CMA-ES (Hansen's `cma`), ask and tell.

    All candidates of an iteration are evaluated together by `run_cases`. It keeps every finished
    case, so a search that was interrupted takes the same way again and evaluates what is missing.
    Random numbers come from `seed` alone: the result is the same for any number of workers, and
    with or without an interruption.
    """

    def __init__(self, problem: SearchProblem[CaseT], budget: SearchBudget, seed: int) -> None:
        self._problem: SearchProblem[Any] = problem
        self._budget = budget
        self._strategy = _strategy(problem.space, budget, seed)
        self._evaluations = 0

    def run(self, run_cases: RunCases) -> SearchResult:
        """Search to the end of the budget. Raises StrideError for a case that cannot be run."""
        budget, strategy = self._budget, self._strategy
        population = budget.population_of(len(self._problem.space.names))
        total = 1 + budget.iterations * population
        with SearchProgress(self._problem.title, total) as progress:
            vector = self._problem.space.start
            [start] = self._evaluated([vector], run_cases, progress)
            best, history = start, [start["cost"]]
            ended: Ending | None = None
            while ended is None:
                vectors = [tuple(map(float, drawn)) for drawn in strategy.ask()]
                results = self._evaluated(vectors, run_cases, progress)
                costs = [result["cost"] for result in results]
                strategy.tell(vectors, costs)
                lowest = int(np.argmin(costs))
                if costs[lowest] < best["cost"]:
                    vector, best = vectors[lowest], results[lowest]
                history.append(best["cost"])
                progress.best(best["cost"])
                ended = self._ending(history)
        return SearchResult(
            vector,
            best["cost"],
            best,
            start,
            len(history) - 1,
            self._evaluations,
            tuple(history),
            ended,
        )

    def _evaluated(
        self, vectors: Sequence[Vector], run_cases: RunCases, progress: SearchProgress
    ) -> list[Result]:
        problem = self._problem
        cases = [problem.case(vector) for vector in vectors]
        results = run_cases(problem.evaluate, cases, progress)
        for result in results:
            if "error" in result:
                raise StrideError(f"{problem.title}: {result['error']}")
        self._evaluations += len(results)
        return results

    def _ending(self, history: list[float]) -> Ending | None:
        budget = self._budget
        if len(history) > budget.iterations:
            return "iterations"
        if len(history) > budget.patience:
            before, now = history[-1 - budget.patience], history[-1]
            if before - now <= budget.progress * abs(now):
                return "still"
        return "converged" if self._strategy.stop() else None


def _strategy(space: SearchSpace, budget: SearchBudget, seed: int) -> Any:
    """A strategy with random numbers of its own: nothing else in the process can disturb them."""
    generator = np.random.default_rng(seed)

    def normal(*shape: int) -> Floats:
        return generator.standard_normal(shape)

    return cma.CMAEvolutionStrategy(
        list(space.start),
        space.sigma,
        {
            "bounds": [list(space.lower), list(space.upper)],
            "popsize": budget.population_of(len(space.names)),
            "maxiter": math.inf,
            "randn": normal,
            "seed": math.nan,
            "verbose": -9,
        },
    )
