"""Progress of a search on standard error, with the best cost so far."""

from typing import Self

from hil.studies.progress import CaseProgress


class SearchProgress:
    """One bar for a whole search: candidates done of at most so many, best cost, time left."""

    def __init__(self, title: str, total: int) -> None:
        self._title = title
        self._bar = CaseProgress(title, total, 0)

    def advance(self) -> None:
        """One more candidate is evaluated."""
        self._bar.advance()

    def best(self, cost: float) -> None:
        """The lowest cost so far."""
        self._bar.rename(f"{self._title}, best {cost:.6g}")

    def __enter__(self) -> Self:
        self._bar.__enter__()
        return self

    def __exit__(self, *exc_info: object) -> None:
        self._bar.__exit__(*exc_info)
