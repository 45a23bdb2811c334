"""Progress of a run on standard error: a bar on a terminal, a line now and then elsewhere."""

import sys
from typing import Any, Protocol, Self

import numpy as np

from hil.start_plan import LONGEST_START_S, SETTLE_S, WAIT_S
from hil.timing import stopwatch_ns

LINE_EVERY_NS = 5_000_000_000
BAR_EVERY_NS = 200_000_000


class Progress(Protocol):
    """Shows how far a run has come; a context manager."""

    def show(self, row: np.void) -> None:
        """Take the newest tick's record."""
        ...

    def __enter__(self) -> Self:
        """Begin."""
        ...

    def __exit__(self, *exc_info: object) -> None:
        """End."""
        ...


class Silence:
    """No progress at all."""

    def show(self, row: np.void) -> None:
        """Show nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc_info: object) -> None:
        return None


class Lines:
    """One plain line every few seconds, for logs."""

    def __init__(self, duration_s: float) -> None:
        self._duration_s = duration_s
        self._last_ns = stopwatch_ns()

    def show(self, row: np.void) -> None:
        """Print a line if it is time for one."""
        now_ns = stopwatch_ns()
        if now_ns - self._last_ns >= LINE_EVERY_NS:
            self._last_ns = now_ns
            sys.stderr.write(f"{describe(row)} of {self._duration_s:g} s\n")
            sys.stderr.flush()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc_info: object) -> None:
        return None


class Bar:
    """A bar that is redrawn five times a second."""

    def __init__(self, duration_s: float) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
        from rich.progress import Progress as RichProgress

        self._bar = RichProgress(
            TextColumn("{task.description}"),
            BarColumn(),
            TimeRemainingColumn(),
            console=Console(stderr=True),
            auto_refresh=False,
            transient=True,
        )
        self._task = self._bar.add_task("starting", total=duration_s)
        self._last_ns = 0

    def show(self, row: np.void) -> None:
        """Redraw if it is time to."""
        now_ns = stopwatch_ns()
        if now_ns - self._last_ns >= BAR_EVERY_NS:
            self._last_ns = now_ns
            done = max(0.0, float(row["time_s"]))
            self._bar.update(self._task, completed=done, description=describe(row))
            self._bar.refresh()

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(self, *exc_info: object) -> None:
        self._bar.stop()


def describe(row: np.void) -> str:
    """Time, speed and steps of a tick, in words."""
    if -WAIT_S - SETTLE_S <= row["time_s"] < -LONGEST_START_S:
        return "stands: lower it onto its feet"
    if row["time_s"] < 0:
        return "standing up"
    motion: Any = row["truth"] if "truth" in (row.dtype.names or ()) else row["estimate"]
    speed = float(np.hypot(*motion["com_velocity"][:2]))
    return f"{row['time_s']:5.1f} s  {speed:4.2f} m/s  {row['status']['steps']:3d} steps"


def make_progress(duration_s: float, *, shown: bool) -> Progress:
    """What suits standard error."""
    if not shown:
        return Silence()
    return Bar(duration_s) if sys.stderr.isatty() else Lines(duration_s)
