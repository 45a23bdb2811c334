"""The run folder: where it is, and meta.json, which says what ran and on what."""

import hashlib
import json
import os
import platform
import subprocess
import sys
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from hil import __version__
from hil.errors import InputError
from hil.robot_facts import body_weight
from hil.session import Session

PARTS = ("mujoco", "numpy", "cma", "dynamixel-sdk", "pyserial", "mcap")


def make_run_folder(out: Path | None, robot: str) -> Path:
    """Create the folder of a run: `out`, or `runs/<time>-<robot>`. Raises InputError."""
    folder = out if out is not None else _unused(robot)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be made: {error.strerror}") from error
    if any(folder.iterdir()):
        raise InputError(f"--out {folder}: is not empty; a run wants a folder of its own")
    return folder


def _unused(robot: str) -> Path:
    stem = f"{datetime.now().astimezone():%Y%m%d-%H%M%S}-{robot}"
    names = [stem, *(f"{stem}-{number}" for number in range(2, 100))]
    return next(path for path in map(Path("runs").joinpath, names) if not path.exists())


def make_meta(session: Session) -> dict[str, Any]:
    """What meta.json holds. Everything in it is known before the run begins."""
    description, request = session.description, session.request
    return {
        "robot": description.name,
        "rung": rung(session),
        "joints": list(description.joint_names),
        "rate_hz": request.rate_hz,
        "seed": request.seed,
        "lockstep": request.lockstep,
        "weight_n": body_weight(description),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "request": request.model_dump(mode="json"),
        "description": description.file,
        "description_sha256": sha256(description.file),
        "model": str(description.model_path),
        "model_sha256": sha256(description.model_path),
        "git_commit": git_commit(),
        "versions": {
            "stridebridge": __version__,
            "python": platform.python_version(),
            **{part: version(part) for part in PARTS},
        },
        "host": {
            "name": platform.node(),
            "system": platform.platform(),
            "machine": platform.machine(),
            "cpus": os.cpu_count(),
        },
        "command": sys.argv,
        "changes": list(session.backend.changes),
        **session.meta,
    }


def rung(session: Session) -> str:
    """Which rung of the ladder a run stands on."""
    request = session.request
    if request.backend == "mujoco":
        body = "simulation"
    else:
        body = "live" if request.bus == "real" else "dry run"
    if request.activity != "walk":
        return f"{body}, {request.activity}"
    return f"{body}, hoisted" if request.hoisted else body


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Write an object, readable and with a newline at its end. Raises InputError."""
    try:
        path.write_text(json.dumps(data, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error


def read_json(path: Path) -> dict[str, Any]:
    """Read an object back. Raises InputError."""
    try:
        data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: is not valid JSON: {error}") from error
    return data


def git_commit() -> str | None:
    """Commit of the checkout this code runs from, `+` if it was changed; None outside one."""
    home = Path(__file__).resolve().parent.parent
    if not (home / ".git").exists():
        return None
    try:
        commit = _git(home, "rev-parse", "--short=12", "HEAD")
        changed = _git(home, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.CalledProcessError):
        return None
    return commit + ("+" if changed else "")


def _git(home: Path, *arguments: str) -> str:
    result = subprocess.run(
        ["git", "-C", str(home), *arguments], capture_output=True, text=True, check=True
    )
    return result.stdout.strip()


def sha256(path: Path | str) -> str:
    """Of a file's content, as meta.json holds it."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
