"""The combiner of simple controllers: which gait styles make the step to come, and how much each.

Seed 003_73fecd8ec8927aad, section 5.1. A simple controller, here a style, belongs to one speed,
one liquid level and one resistance of the liquid, and names only the trajectories in which it
differs from the standard controller; it need not walk by itself, since balance is the pendulum
model's.
"""

from bisect import bisect_right
from collections.abc import Sequence
from typing import Literal

from pydantic import Field, PositiveFloat

from hil.validation import Config

Law = Literal["square", "symmetric"]
KnotList = tuple[tuple[float, float], ...]
PATH = ("swing_ahead", "swing_aside")
"""Trajectories of the swing foot that a style may have besides key poses."""


class StyleConfig(Config):
    """One simple controller."""

    speed: float
    """Sagittal speed that it is for [m/s]."""
    water: float = Field(default=0.0, ge=0)
    """Level of the liquid that it is for [m]."""
    resistance: PositiveFloat = 1.0
    """Drag of that liquid over the drag of water, ρμ/ρ_water."""
    poses: dict[str, KnotList] = {}
    """Trajectories that differ from the standard controller, by their names in `key_poses`, and
    `swing_ahead` and `swing_aside`: the swing ankle from its hip along and across the heading
    until the pendulum takes it over [m], of a step on the left foot."""

    @property
    def cell(self) -> tuple[float, float, float]:
        """Speed [m/s], level [m] and resistance that it is for."""
        return self.speed, self.water, self.resistance


def share(value: float, low: float, high: float, law: Law) -> float:
    """R, the part of the upper of two neighbours: 0 at `low`, 1 at `high`.

    With a = (value − low)/(high − low): `square` is a² as printed in the seed, which changes its
    slope at every reference; `symmetric` is a²/(a² + (1 − a)²), with zero slope at both ends (the
    first author's stored code).
    """
    a = (value - low) / (high - low)
    if law == "square":
        return a * a
    return a * a / (a * a + (1.0 - a) * (1.0 - a))


def neighbours(value: float, marks: Sequence[float], law: Law) -> list[tuple[int, float]]:
    """Indices and parts of the rising marks around a value; the nearest alone outside them."""
    above = bisect_right(marks, value)
    if above == 0:
        return [(0, 1.0)]
    if above == len(marks):
        return [(above - 1, 1.0)]
    part = share(value, marks[above - 1], marks[above], law)
    return [(above - 1, 1.0 - part), (above, part)] if part > 0.0 else [(above - 1, 1.0)]


class Combiner:
    """Parts of the styles at a speed, a level and a resistance, mixed in this order.

    f = f_1·(1 − R) + f_2·R of the two nearest styles, by speed among those of one level and one
    resistance, then of the two nearest levels of one resistance, and then of the two nearest
    resistances in the same way.
    """

    def __init__(self, styles: Sequence[StyleConfig], law: Law) -> None:
        self._law: Law = law
        table: dict[float, dict[float, list[tuple[float, int]]]] = {}
        for index, style in enumerate(styles):
            rows = table.setdefault(style.resistance, {})
            rows.setdefault(style.water, []).append((style.speed, index))
        self._resistances = sorted(table)
        self._liquids = [
            [(level, sorted(row)) for level, row in sorted(table[at].items())]
            for at in self._resistances
        ]

    def parts(self, speed: float, level: float, resistance: float = 1.0) -> dict[int, float]:
        """Index of every style that takes part and its part; the parts sum to 1."""
        law, result = self._law, {}
        for liquid, share_of_liquid in neighbours(resistance, self._resistances, law):
            rows = self._liquids[liquid]
            for row, share_of_row in neighbours(level, [mark for mark, _ in rows], law):
                places = rows[row][1]
                for place, within in neighbours(speed, [mark for mark, _ in places], law):
                    result[places[place][1]] = share_of_liquid * share_of_row * within
        return result
