"""The computer as the checks see it: files below a root, limits, programs. Tests give another."""

import os
import platform
import resource
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Literal

Status = Literal["OK", "WARN", "FAIL"]
PROGRAM_TIMEOUT_S = 2.0
"""Longest that a helper program may take."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report."""

    status: Status
    what: str
    found: str
    fix: str = ""
    """What to do; empty where all is well."""


def _run(command: list[str]) -> str | None:
    """Standard output of a program; None where it is not there or fails."""
    if shutil.which(command[0]) is None:
        return None
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=PROGRAM_TIMEOUT_S, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout


def _package(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _limit(which: int) -> int:
    """Soft limit of this process; -1 is none."""
    return resource.getrlimit(which)[0]


@dataclass(frozen=True, slots=True)
class Machine:
    """Everything that a check may ask."""

    root: Path = Path("/")
    """Where /sys, /dev, /proc and /usr are."""
    run: Callable[[list[str]], str | None] = _run
    package: Callable[[str], str | None] = _package
    """Version of an installed Python package, or None."""
    limit: Callable[[int], int] = _limit
    """Soft limit by its `resource` number; -1 is unlimited."""
    accessible: Callable[[Path], bool] = lambda path: os.access(path, os.R_OK | os.W_OK)
    free_bytes: Callable[[Path], int] = lambda path: shutil.disk_usage(path).free
    python: str = platform.python_version()
    environment: dict[str, str] = field(default_factory=lambda: dict(os.environ))
    folder: Path = field(default_factory=Path.cwd)
    """Where runs are written."""

    def read(self, path: str) -> str | None:
        """Content of a small file below the root, stripped; None where it cannot be read."""
        try:
            return (self.root / path).read_text(encoding="utf-8", errors="replace").strip("\0\n ")
        except OSError:
            return None

    def find(self, *patterns: str) -> list[Path]:
        """Files below the root that match one of the patterns, sorted."""
        return sorted({path for pattern in patterns for path in self.root.glob(pattern)})
