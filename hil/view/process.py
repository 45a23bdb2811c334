"""The view's own process: `python -m hil.view.process` with its job as JSON on standard input.

It reads the run's ticks from shared memory and says back what is steered. Whatever happens to it,
the run goes on.
"""

import json
import os
import platform
import signal
import socket
import sys
from typing import Any

from hil.errors import InputError, StrideError
from hil.record_layout import tick_dtype
from hil.recorder_ring import Ring
from hil.robot_files import load_robot
from hil.view.feed import FAILED, READY
from hil.view.live import LiveRun

NICE = 10
"""The run's own processes come first."""


def main() -> int:
    """Show one run; the process's exit status."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # the run decides when it ends, not the terminal
    os.nice(NICE)
    job: dict[str, Any] = json.load(sys.stdin)
    link = socket.socket(fileno=job["socket"])
    ring = Ring(job["ring"], tick_dtype(job["joints"], truth=job["truth"]))
    live = LiveRun(ring, link, job["parent"])
    try:
        _show(job, live, link)
    except StrideError as error:
        link.send((FAILED + str(error)).encode())
        return 1
    return 0


def _show(job: dict[str, Any], live: LiveRun, link: socket.socket) -> None:
    # Studio takes a second to import, and is not needed to refuse a job.
    from hil.view.show import Show
    from hil.view.stage import stage_model

    description = load_robot(job["robot"], tuple(job["overrides"]))
    model = stage_model(description)
    title = f"stride: {description.name}, {job['rung']}"
    screen = _screen(job["view"], title, model)
    try:
        show = Show(job, description, screen, live)
        link.send((READY + screen.place).encode())
        show.run()
        screen.exit_reason = "the run is over"
    finally:
        screen.close()


def _screen(view: str, title: str, model: Any) -> Any:
    """Where it is shown. Raises InputError where it cannot be."""
    if view == "web":
        from hil.view.web import WebScreen

        return WebScreen(title, model)
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError("native needs a display, and there is none here; --view web does not")
    try:
        from hil.view.native import NativeScreen
    except ImportError as error:  # MuJoCo 4.0.0's window wants Python 3.12
        raise InputError(
            f"native: MuJoCo's window does not load in Python {platform.python_version()} (MuJoCo "
            "4.0.0 wants 3.12 for it); --view web does"
        ) from error
    return NativeScreen(title, model)


if __name__ == "__main__":
    sys.exit(main())
