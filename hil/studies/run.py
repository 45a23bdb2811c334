"""One study from its settings to its folder: cases, CSV and figure."""

import csv
import os
from dataclasses import dataclass
from pathlib import Path

from hil.errors import InputError
from hil.studies.engine import CaseRunner
from hil.studies.folder import StudyFolder
from hil.studies.study import Result, Study, StudyResult


@dataclass(frozen=True, slots=True)
class StudyRun:
    """A finished study and where it is."""

    folder: Path
    result: StudyResult
    notes: list[str]


def run_study(study: Study, out: Path | None, jobs: int | None) -> StudyRun:
    """Run what is missing of a study, then write `<study>.csv` and `<study>.png`."""
    workers = jobs if jobs is not None else len(os.sched_getaffinity(0))
    if workers < 1:
        raise InputError(f"--jobs: must be at least 1 (got {jobs})")
    with StudyFolder(study, out) as folder, CaseRunner(folder, workers) as run_cases:
        result = study.conduct(run_cases)
        write_csv(folder.path / f"{study.name}.csv", result.rows)
        result.draw(folder.path / f"{study.name}.png")
    notes = [folder.note] if folder.note else []
    return StudyRun(folder.path, result, notes + result.notes)


def write_csv(path: Path, rows: list[Result]) -> None:
    """Rows with the keys of the first one as the head; nothing is written as an empty field."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [])
        writer.writeheader()
        writer.writerows(rows)
