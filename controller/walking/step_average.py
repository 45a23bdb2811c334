"""The mean of a quantity over one step."""

from dataclasses import dataclass


@dataclass(slots=True)
class StepAverage:
    """Mean of what was added since the step began."""

    _total: float = 0.0
    _count: int = 0

    def add(self, value: float) -> None:
        """Count the value of one tick."""
        self._total += value
        self._count += 1

    def finish(self) -> float:
        """The mean since the last call, 0 when nothing was added; starts the next step."""
        mean = self._total / self._count if self._count else 0.0
        self._total, self._count = 0.0, 0
        return mean
