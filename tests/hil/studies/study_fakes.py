"""A study whose cases are arithmetic, and a program that runs it."""

import os
import sys
import time
from pathlib import Path
from typing import ClassVar

from hil.errors import BackendError
from hil.request import RunRequest
from hil.studies.run import run_study
from hil.studies.study import Case, Study, StudyResult, Table


class NumberCase(Case):
    number: int
    log: str
    wait_s: float


class NumberStudy(Study):
    """The squares of the first numbers."""

    name: ClassVar[str] = "numbers"
    first: int
    count: int
    log: str
    """Folder in which every case that runs leaves a file."""
    wait_s: float = 0.0

    def conduct(self, run_cases):
        cases = [
            NumberCase(request=self.request, number=number, log=self.log, wait_s=self.wait_s)
            for number in range(self.first, self.count)
        ]
        results = run_cases(square, cases)
        rows = [
            {"number": case.number, "square": None, "error": None} | result
            for case, result in zip(cases, results, strict=True)
        ]
        cells = [tuple(map(str, row.values())) for row in rows]
        table = Table("squares", ("number", "square", ""), cells)
        return StudyResult(rows, [table], draw)


def draw(path):
    path.write_bytes(b"\x89PNG")


def square(case):
    """Its square; small numbers take longer. 5 is an error of ours, 20 a crash, 99 a defect."""
    with (Path(case.log) / f"{case.number}-{os.getpid()}-{time.monotonic_ns()}").open("w"):
        pass
    time.sleep(case.wait_s + 0.01 * max(0, 4 - case.number))
    if case.number == 5:
        raise BackendError("five is not for this robot")
    if case.number == 20:
        os._exit(1)
    if case.number == 99:
        raise ZeroDivisionError("a defect")
    return {"square": case.number**2}


def numbers(log, count=8, first=0, wait_s=0.0, robot="human"):
    log.mkdir(exist_ok=True)
    request = RunRequest(robot=robot, backend="mujoco", rate_hz=300)
    return NumberStudy(request=request, first=first, count=count, log=str(log), wait_s=wait_s)


if __name__ == "__main__":
    from study_fakes import numbers as named  # so that workers find the classes by this name

    run_study(named(Path(sys.argv[1]), count=12, wait_s=0.3), Path(sys.argv[2]), jobs=2)
