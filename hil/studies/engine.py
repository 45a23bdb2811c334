"""Runs the cases of a study in parallel processes, each of them once."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, ExitStack
from types import TracebackType
from typing import Self

from hil.errors import StrideError
from hil.studies.folder import StudyFolder
from hil.studies.progress import CaseProgress
from hil.studies.study import CaseT, Counter, Result, StudyResult, case_key
from hil.studies.worker import run_case
from hil.studies.workers import dask_workers, local_processes


class CaseRunner:
    """Hands missing cases to worker processes and keeps what they return in the study's folder.

    Every case runs in a worker, also with one job, so that results do not depend on the number of
    jobs, nor on where the workers are: in processes of this machine, or at a Dask `scheduler`.
    Raises StrideError when a worker dies; what an unfit case raised is raised again.
    """

    def __init__(self, folder: StudyFolder, jobs: int, scheduler: str | None = None) -> None:
        self._folder = folder
        self._jobs = jobs
        self._scheduler = scheduler
        self._workers = ExitStack()
        self._executor: Executor | None = None

    def __call__(
        self,
        function: Callable[[CaseT], Result],
        cases: Sequence[CaseT],
        counter: Counter | None = None,
    ) -> list[Result]:
        """Results in the order of the cases. `function` is importable by its module's name."""
        kept = self._folder.results
        keys = [case_key(case) for case in cases]
        distinct = dict(zip(keys, cases, strict=True))
        missing = [case for key, case in distinct.items() if key not in kept]
        if counter is not None:
            for _ in range(len(cases) - len(missing)):
                counter.advance()
            self._run(function, missing, counter)
        elif missing:
            done = len(distinct) - len(missing)
            with CaseProgress(self._folder.path.name, len(distinct), done) as progress:
                self._run(function, missing, progress)
        return [kept[key] for key in keys]

    def publish(self, result: StudyResult) -> None:
        """Write what is known so far into the folder."""
        self._folder.publish(result)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End the workers; if the study was cut short, without waiting for their cases."""
        if error is not None:
            error.add_note(
                f"finished cases are kept in {self._folder.path}: the same command goes on there"
            )
        self._workers.__exit__(kind, error, traceback)

    def _run(
        self, function: Callable[[CaseT], Result], cases: Sequence[CaseT], counter: Counter
    ) -> None:
        for case, result in self._finished(function, cases):
            self._folder.append(case, result)
            counter.advance()

    def _finished(
        self, function: Callable[[CaseT], Result], cases: Sequence[CaseT]
    ) -> Iterator[tuple[CaseT, Result]]:
        """Cases with their results, as they come."""
        if self._executor is None:
            self._executor = self._workers.enter_context(self._make_workers())
        futures = {self._executor.submit(run_case, function, case): case for case in cases}
        for future in as_completed(futures):
            case = futures[future]
            try:
                yield case, future.result()
            except BrokenProcessPool as error:
                raise StrideError("a worker process died") from error
            except Exception as error:
                error.add_note(f"in the case {case_key(case)}")
                raise

    def _make_workers(self) -> AbstractContextManager[Executor]:
        if self._scheduler is not None:
            return dask_workers(self._scheduler)
        return local_processes(self._jobs)
