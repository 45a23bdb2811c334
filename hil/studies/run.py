"""One study from its settings to its folder: cases, CSV and figure."""

import os
from dataclasses import dataclass
from pathlib import Path

from hil.errors import InputError
from hil.studies.engine import CaseRunner
from hil.studies.folder import StudyFolder
from hil.studies.study import Study, StudyResult


@dataclass(frozen=True, slots=True)
class StudyRun:
    """A finished study and where it is."""

    folder: Path
    result: StudyResult
    notes: list[str]


def run_study(
    study: Study, out: Path | None, jobs: int | None, scheduler: str | None = None
) -> StudyRun:
    """Run what is missing of a study, then write `<study>.csv` and `<study>.png`.

    Cases run in `jobs` processes here, or on the workers of a Dask `scheduler` (its address).
    """
    if jobs is not None and scheduler is not None:
        raise InputError("--jobs counts processes here, --scheduler has workers of its own")
    workers = jobs if jobs is not None else len(os.sched_getaffinity(0))
    if workers < 1:
        raise InputError(f"--jobs: must be at least 1 (got {jobs})")
    with StudyFolder(study, out) as folder, CaseRunner(folder, workers, scheduler) as run_cases:
        result = study.conduct(run_cases)
        folder.publish(result)
    notes = [folder.note] if folder.note else []
    return StudyRun(folder.path, result, notes + result.notes)
