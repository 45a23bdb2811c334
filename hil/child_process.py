"""Processes of our own beside a run: a module of this program, its job, and what it inherits."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hil.errors import BackendError


def spawn(module: str, job: dict[str, Any], descriptors: Sequence[int]) -> subprocess.Popen[bytes]:
    """Start `python -m module` with a job as JSON on its standard input.

    It has a session of its own, so that Ctrl-C does not reach it. Raises BackendError.
    """
    home = str(Path(__file__).resolve().parent.parent)
    paths = [home, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    process = subprocess.Popen(
        [sys.executable, "-m", module],
        stdin=subprocess.PIPE,
        pass_fds=descriptors,
        env=environment,
        start_new_session=True,
    )
    if process.stdin is None:
        raise BackendError(f"{module} has no input")
    process.stdin.write(json.dumps(job).encode())
    process.stdin.close()
    return process
