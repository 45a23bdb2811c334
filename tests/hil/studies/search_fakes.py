"""A search over arithmetic, as a study, and a program that runs it."""

import os
import sys
import time
from pathlib import Path
from typing import ClassVar

from hil.errors import BackendError
from hil.request import RunRequest
from hil.studies.run import run_study
from hil.studies.search.budget import SearchBudget
from hil.studies.search.cma_search import Search
from hil.studies.search.problem import SearchProblem
from hil.studies.search.space import SearchSpace
from hil.studies.study import Case, Study, StudyResult
from hil.studies.worker import run_case


class InThisProcess:
    """Runs cases without workers, and keeps none."""

    def __call__(self, function, cases, counter=None):
        results = []
        for case in cases:
            results.append(run_case(function, case))
            if counter is not None:
                counter.advance()
        return results

    def publish(self, result):
        pass


class BowlCase(Case):
    vector: tuple[float, ...]
    log: str
    wait_s: float
    deadly: bool


class BowlStudy(Study):
    """The lowest point of an ellipsoid at (1, 2, 3), for which 2.5 is the upper bound."""

    name: ClassVar[str] = "bowl"
    log: str
    seed: int = 1
    wait_s: float = 0.0
    deadly: bool = False
    """The search kills its worker."""
    iterations: int = 60
    patience: int = 60
    start: tuple[float, ...] = (0.0, 0.0, 0.0)

    def conduct(self, run_cases):
        found = Search(self.problem(), self.budget(), self.seed).run(run_cases)
        row = {"vector": list(found.vector), "cost": found.cost, "ended": found.ended,
               "iterations": found.iterations, "evaluations": found.evaluations,
               "history": list(found.history)}  # fmt: skip
        return StudyResult([row], [], lambda path: path.write_bytes(b"\x89PNG"))

    def budget(self):
        return SearchBudget(iterations=self.iterations, population=6, patience=self.patience)

    def problem(self):
        space = SearchSpace(("x", "y", "z"), self.start, 0.3, (-4.0,) * 3, (2.5,) * 3)
        return SearchProblem("bowl", space, self.case, bowl)

    def case(self, vector):
        return BowlCase(
            request=self.request, vector=vector, log=self.log, wait_s=self.wait_s,
            deadly=self.deadly,
        )  # fmt: skip


def bowl(case):
    with (Path(case.log) / f"{os.getpid()}-{time.monotonic_ns()}").open("w"):
        pass
    time.sleep(case.wait_s)
    x, y, z = case.vector
    if case.deadly:
        os._exit(1)
    if x < -3.8:
        raise BackendError("x is not for this robot")
    return {"cost": (x - 1) ** 2 + 10 * (y - 2) ** 2 + 0.1 * (z - 3) ** 2, "x": x}


def bowls(log, **settings):
    log.mkdir(exist_ok=True)
    request = RunRequest(robot="human", backend="mujoco", rate_hz=300)
    return BowlStudy(request=request, log=str(log), **settings)


if __name__ == "__main__":
    from search_fakes import bowls as named  # so that workers find the classes by this name

    run_study(named(Path(sys.argv[1]), wait_s=0.05, iterations=20), Path(sys.argv[2]), jobs=2)
