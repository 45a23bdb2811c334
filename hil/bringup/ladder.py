"""The ladder of a real robot: on the ground walks only who has walked in the air.

Passed hoisted walks are on record beside the calibration file, in `NAME.rungs.json`: they belong to
one robot as it was calibrated, wherever runs are kept (docs/decisions/0007-rungs-on-record.md).
"""

import hashlib
import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from hil.description import RobotDescription
from hil.errors import DescriptionError, InputError
from hil.run_folder import read_json, write_json
from hil.session import Session

LEAST_S = 5.0
"""A hoisted walk passes when it was at least so long [s]: every joint has then moved in about
seven steps of its leg."""
HOISTED = "hoisted walk"


def calibration_file(description: RobotDescription) -> Path:
    """The calibration file of a robot. Raises DescriptionError where the robot file names none."""
    if description.calibration is None:
        raise DescriptionError(
            description.file, "calibration", "is missing: a real robot has one (stride calibrate)"
        )
    return Path(description.file).parent / description.calibration


def record_file(description: RobotDescription) -> Path:
    """Where the passed rungs of a robot are on record."""
    file = calibration_file(description)
    return file.with_name(f"{file.stem}.rungs.json")


def wiring(description: RobotDescription) -> str:
    """What distinguishes joints, buses, boards and feet of a robot, but for ports: 16 digits."""
    parts = description.model_dump(
        mode="json",
        include={"joints": True, "buses": True, "boards": True, "feet": True, "imu": True},
        exclude={"buses": {name: {"port"} for name in description.buses},
                 "boards": {name: {"port"} for name in description.boards}},
    )  # fmt: skip
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]


def on_the_ground(session: Session) -> bool:
    """Whether a session is a walk of a real robot on its feet."""
    request = session.request
    return request.live and request.activity == "walk" and not request.hoisted


def require_hoisted_walk(session: Session) -> None:
    """Raise InputError unless a hoisted walk of this robot, calibrated like this, has passed."""
    file = record_file(session.description)
    passed = _records(file)
    if any(_is_of(record, session) for record in passed):
        return
    reason = "none is on record"
    if passed:
        what = "wiring" if passed[-1]["calibration"] == _identity(session) else "calibration"
        reason = f"the last one on record had another {what}"
    raise InputError(
        f"{session.description.name} may walk on the ground after a passed hoisted walk, and "
        f"{reason} ({file}): hang it up, then run: stride walk {session.request.robot} --live "
        "--hoisted"
    )


def note_hoisted_walk(session: Session, folder: Path, report: dict[str, Any]) -> str | None:
    """Put a hoisted walk of a real robot on record if it passed; what to tell of it.

    None for any other run. Raises InputError where the record cannot be written.
    """
    if not (session.request.live and session.request.hoisted):
        return None
    problem = why_not_passed(report)
    if problem is not None:
        return f"hoisted walk not passed: {problem}"
    file = record_file(session.description)
    record = {
        "rung": HOISTED,
        "robot": session.description.name,
        "calibration": _identity(session),
        "wiring": wiring(session.description),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "duration_s": report["duration_s"],
        "rate_hz": report["rate_hz"],
        "folder": str(folder),
    }
    write_json(file, {"passed": [*_records(file), record]})
    return f"hoisted walk passed, on record in {file}"


def why_not_passed(report: dict[str, Any]) -> str | None:
    """What keeps a run's report from being a pass; None where nothing does."""
    stopped = [fault for fault in report["faults"] if fault["reaction"] != "none"]
    if stopped:
        return f"{stopped[0]['source']}: {stopped[0]['name']}"
    if report["fell"]:
        return "it fell"
    if report["duration_s"] < LEAST_S:
        return f"it was {report['duration_s']:g} s long, {LEAST_S:g} s are needed"
    return None


def _identity(session: Session) -> str:
    identity: str = session.meta["calibration"]["identity"]
    return identity


def _is_of(record: dict[str, Any], session: Session) -> bool:
    wanted = {
        "rung": HOISTED,
        "robot": session.description.name,
        "calibration": _identity(session),
        "wiring": wiring(session.description),
    }
    return all(record.get(key) == value for key, value in wanted.items())


def _records(file: Path) -> list[dict[str, Any]]:
    """Passed rungs, oldest first. Raises InputError for a file that is not ours."""
    if not file.exists():
        return []
    passed = read_json(file).get("passed")
    if not isinstance(passed, list) or not all(isinstance(record, dict) for record in passed):
        raise InputError(f"{file}: passed: must be a list of records; move the file away")
    return passed
