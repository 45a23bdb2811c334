"""Runs the cases of a study in parallel processes, each of them once."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import active_children, get_context
from types import TracebackType
from typing import Self

from hil.errors import StrideError
from hil.studies.folder import StudyFolder
from hil.studies.progress import CaseProgress
from hil.studies.study import CaseT, Result, case_key
from hil.studies.worker import prepare_worker, run_case


class CaseRunner:
    """Hands missing cases to worker processes and keeps what they return in the study's folder.

    Every case runs in a worker, also with one job, so that results do not depend on the number of
    jobs. Raises StrideError when a worker dies; what an unfit case raised is raised again.
    """

    def __init__(self, folder: StudyFolder, jobs: int) -> None:
        self._folder = folder
        self._jobs = jobs
        self._others = set(active_children())
        self._pool: ProcessPoolExecutor | None = None

    def __call__(self, function: Callable[[CaseT], Result], cases: Sequence[CaseT]) -> list[Result]:
        """Results in the order of the cases. `function` is importable by its module's name."""
        kept = self._folder.results
        distinct = list(dict.fromkeys(cases))
        missing = [case for case in distinct if case_key(case) not in kept]
        if missing:
            done = len(distinct) - len(missing)
            with CaseProgress(self._folder.path.name, len(distinct), done) as progress:
                for case, result in self._finished(function, missing):
                    self._folder.append(case, result)
                    progress.advance()
        return [kept[case_key(case)] for case in cases]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End the workers; if the study was cut short, without waiting for their cases."""
        if self._pool is None:
            return
        if error is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            for worker in set(active_children()) - self._others:
                worker.kill()
            error.add_note(
                f"finished cases are kept in {self._folder.path}: the same command goes on there"
            )
        self._pool.shutdown()

    def _finished(
        self, function: Callable[[CaseT], Result], cases: Sequence[CaseT]
    ) -> Iterator[tuple[CaseT, Result]]:
        """Cases with their results, as they come."""
        if self._pool is None:
            spawn = get_context("spawn")  # no copied threads, and the same on every system
            self._pool = ProcessPoolExecutor(self._jobs, spawn, prepare_worker)
        futures = {self._pool.submit(run_case, function, case): case for case in cases}
        for future in as_completed(futures):
            case = futures[future]
            try:
                yield case, future.result()
            except BrokenProcessPool as error:
                raise StrideError("a worker process died") from error
            except Exception as error:
                error.add_note(f"in the case {case_key(case)}")
                raise
