"""Algorithm 1 of seed 000_bd1305a0ae731442, section 4.2: ranges of acceptable gains, rate by rate.

As printed, the loops repeat a search while the gains change by *less* than η: they would stop at
the first run that changes anything. Here they go on while the gains change by more.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from hil.compose.optimisations import gain_space
from hil.joint_gains import GainSet
from hil.studies.gain_walks import Side

LARGE_SHARE = 0.2
"""The next rate starts from so much of the largest gains, and for the rest from the smallest."""


@dataclass(frozen=True, slots=True)
class Run:
    """What one run of CMA found."""

    gains: GainSet
    """The best set, which may be the start."""
    valid: bool
    """Whether its motion is stable and similar."""
    cost: float
    iterations: int
    evaluations: int
    ended: str


class RunCma(Protocol):
    """One run of CMA from a start set, by whose gains the cost is normalised."""

    def __call__(self, start: GainSet, rate_hz: int, side: Side, number: int) -> Run:
        """`number` counts the runs of a rate and side from 0."""
        ...


@dataclass(slots=True)
class Extreme:
    """Smallest or largest gains of a rate, and the runs that led there."""

    runs: list[Run] = field(default_factory=list)

    @property
    def last(self) -> Run:
        """The run whose gains count."""
        return self.runs[-1]


@dataclass(frozen=True, slots=True)
class RateRange:
    """The range of one rate; `largest` is missing where no stable motion was found."""

    rate_hz: int
    start: GainSet
    smallest: Extreme
    largest: Extreme | None


def lower_frequency(
    start: GainSet, rates_hz: Sequence[int], run_cma: RunCma, eta: float, most_runs: int
) -> Iterator[RateRange]:
    """Ranges from the first rate down, to the last or to the first without a stable motion."""
    gains = start
    for rate_hz in rates_hz:
        found = optimize_frequency(gains, rate_hz, run_cma, eta, most_runs)
        yield found
        if found.largest is None:
            return
        smallest, largest = found.smallest.last.gains, found.largest.last.gains
        gains = gain_space.blended(smallest, largest, LARGE_SHARE)


def optimize_frequency(
    start: GainSet, rate_hz: int, run_cma: RunCma, eta: float, most_runs: int
) -> RateRange:
    """Smallest, then, if there is a stable motion, largest gains of a rate."""
    smallest = _extreme(
        start, lambda gains, number: run_cma(gains, rate_hz, "min", number), eta, most_runs
    )
    if not smallest.last.valid:
        return RateRange(rate_hz, start, smallest, None)
    largest = _extreme(
        smallest.last.gains,
        lambda gains, number: run_cma(gains, rate_hz, "max", number),
        eta,
        most_runs,
    )
    return RateRange(rate_hz, start, smallest, largest)


def change(before: GainSet, after: GainSet) -> float:
    """Root mean square of the relative changes of all gains."""
    pairs = [
        (old, new)
        for joint in before
        for old, new in zip(before[joint], after[joint], strict=True)
        if old > 0.0
    ]
    squares = [(new / old - 1.0) ** 2 for old, new in pairs]
    return float((sum(squares) / len(squares)) ** 0.5)


def _extreme(
    start: GainSet, run: Callable[[GainSet, int], Run], eta: float, most_runs: int
) -> Extreme:
    """Run CMA from its own result while that changes by more than η and is valid."""
    found = Extreme()
    gains = start
    for number in range(most_runs):
        found.runs.append(run(gains, number))
        if not found.last.valid or change(gains, found.last.gains) <= eta:
            break
        gains = found.last.gains
    return found
