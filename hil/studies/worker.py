"""The worker's side of a study: one case in a process of its own."""

import os
import signal
import threading
from collections.abc import Callable
from multiprocessing import parent_process

from hil import __version__
from hil.errors import StrideError
from hil.studies.study import CaseT, Result


def prepare_worker() -> None:
    """Leave Ctrl-C to the study, and end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_the_study, daemon=True).start()


def worker_version() -> str:
    """Version of this program where the worker runs."""
    return __version__


def run_case(function: Callable[[CaseT], Result], case: CaseT) -> Result:
    """The result of a case; an error of ours is a result as well."""
    try:
        return function(case)
    except StrideError as error:
        return {"error": str(error)}


def _end_with_the_study() -> None:
    """An idle worker would wait for ever on a queue whose other end was killed."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
