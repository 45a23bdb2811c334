"""Progress of a study on standard error: a bar on a terminal, a line now and then elsewhere."""

import sys
from typing import Any, Self

from hil.timing import stopwatch_ns

LINE_EVERY_NS = 10_000_000_000


class CaseProgress:
    """How many cases are done, and how long the rest may take."""

    def __init__(self, title: str, total: int, done: int) -> None:
        self._title, self._total, self._done = title, total, done
        self._last_ns = stopwatch_ns()
        self._said = -1
        self._bar: Any = self._make_bar() if sys.stderr.isatty() else None

    def advance(self) -> None:
        """One more case is done."""
        self._done += 1
        if self._bar is not None:
            self._bar.advance(self._task)
        elif stopwatch_ns() - self._last_ns >= LINE_EVERY_NS:
            self._say()

    def rename(self, title: str) -> None:
        """Show another title from now on."""
        self._title = title
        if self._bar is not None:
            self._bar.update(self._task, description=title)

    def __enter__(self) -> Self:
        if self._bar is not None:
            self._bar.start()
        return self

    def __exit__(self, *exc_info: object) -> None:
        if self._bar is not None:
            self._bar.stop()
        elif exc_info[0] is None and self._said != self._done:
            self._say()

    def _say(self) -> None:
        self._said = self._done
        self._last_ns = stopwatch_ns()
        sys.stderr.write(f"{self._title}: {self._done} of {self._total} cases\n")
        sys.stderr.flush()

    def _make_bar(self) -> Any:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=Console(stderr=True),
            transient=True,
        )
        self._task = bar.add_task(self._title, total=self._total, completed=self._done)
        return bar
