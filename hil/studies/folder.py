"""The folder of a study: what it is (study.json) and every finished case (cases.jsonl)."""

import csv
import fcntl
import json
import sys
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TextIO

from hil import __version__
from hil.errors import InputError
from hil.robot_files import load_robot
from hil.run_folder import git_commit, read_json, sha256, write_json
from hil.studies.study import Case, Result, Study, StudyResult, case_key

IDENTITY = ("study", "robot", "settings", "description_sha256", "model_sha256", "version")
"""Keys of study.json in which two studies must agree to share results."""


class StudyFolder:
    """Keeps the results of one study across interruptions.

    A case is written when it is done, as one line; a line that a crash cut short is dropped. One
    process at a time holds the folder. Raises InputError for a folder of something else.
    """

    def __init__(self, study: Study, out: Path | None) -> None:
        what = describe(study)
        self.path = out or Path("studies") / f"{study.name}-{what['robot']}"
        self._name = study.name
        self.note: str | None = None
        """What a user must know of the results that are already here."""
        self._make()
        self._file = self._lock()
        self.results: dict[str, Result] = self._read()
        """Of every finished case, by `case_key`."""
        try:
            self._adopt(what)
        except InputError:
            self._file.close()
            raise

    def append(self, case: Case, result: Result) -> None:
        """Keep a result: it is in the file when this returns."""
        key = case_key(case)
        line = {"case": json.loads(key), "result": result}
        self._file.write(json.dumps(line, allow_nan=False) + "\n")
        self._file.flush()
        self.results[key] = result

    def publish(self, result: StudyResult) -> None:
        """Write `<study>.csv`, `<study>.png` and what else there is, in place of older ones."""
        write_csv(self.path / f"{self._name}.csv", result.rows)
        result.draw(self.path / f"{self._name}.png")
        for name, text in result.files.items():
            (self.path / name).write_text(text, encoding="utf-8")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._file.close()

    def _make(self) -> None:
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"--out {self.path}: cannot be made: {error.strerror}") from error
        if not (self.path / "study.json").exists() and any(self.path.iterdir()):
            raise InputError(f"--out {self.path}: is not empty and holds no study")

    def _adopt(self, what: dict[str, Any]) -> None:
        """Claim a folder without results, or check that the study in it is this one."""
        path = self.path / "study.json"
        found = read_json(path) if path.exists() else dict.fromkeys(IDENTITY)
        if not self.results and set(IDENTITY) <= set(found):
            write_json(path, what)
            return
        different = [key for key in IDENTITY if found.get(key) != what[key]]
        if different:
            raise InputError(
                f"--out {self.path}: holds the study {found.get('study')} of "
                f"{found.get('robot')} with other {', '.join(_details(found, what, different))}: "
                "give another --out, or delete the folder"
            )
        if found.get("git_commit") != what["git_commit"]:
            self.note = (
                f"{self.path}: results made at commit {found.get('git_commit')} are kept; the "
                f"code is now at {what['git_commit']}"
            )

    def _lock(self) -> TextIO:
        file = (self.path / "cases.jsonl").open("a+", encoding="utf-8")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            file.close()
            raise InputError(f"--out {self.path}: another process is at this study") from error
        return file

    def _read(self) -> dict[str, Result]:
        self._file.seek(0)
        text = self._file.read()
        whole = text[: text.rfind("\n") + 1]
        if len(whole) < len(text):
            self._file.truncate(len(whole.encode()))
        lines = [json.loads(line) for line in whole.splitlines()]
        return {json.dumps(line["case"], sort_keys=True): line["result"] for line in lines}


def describe(study: Study) -> dict[str, Any]:
    """What study.json holds."""
    description = load_robot(study.request.robot, study.request.overrides)
    return {
        "study": study.name,
        "robot": description.name,
        "settings": study.model_dump(mode="json"),
        "description_sha256": sha256(description.file),
        "model_sha256": sha256(description.model_path),
        "version": __version__,
        "git_commit": git_commit(),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": sys.argv,
    }


def write_csv(path: Path, rows: list[Result]) -> None:
    """Rows with the keys of the first one as the head; nothing is written as an empty field."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [])
        writer.writeheader()
        writer.writerows(rows)


def _details(found: dict[str, Any], what: dict[str, Any], different: list[str]) -> list[str]:
    """Names of what differs; of the settings, which ones."""
    if "settings" not in different or "study" in different:
        return different
    old, new = found["settings"], what["settings"]
    names = [f"settings.{name}" for name in new if new[name] != old.get(name)]
    return [name for name in different if name != "settings"] + names
