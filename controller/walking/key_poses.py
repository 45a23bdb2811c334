"""Key poses: smooth curves through a few knots over the phase of a step.

Seed 000_bd1305a0ae731442, section 3: key poses are the input data of every joint but those of
the swing leg. Knots are joined by Catmull-Rom splines and held constant outside.
"""

from collections.abc import Sequence

import numpy as np

from hil.interface import Floats

Knots = Sequence[tuple[float, float]]
SAMPLES = 513
"""Points of a tabulated curve: errors below 0.001 where a steep curve ends, less elsewhere."""


def catmull_rom(knots: Knots, phases: Floats) -> Floats:
    """Values at phases of the spline through (phase, value) knots with rising phases.

    Cubic Hermite between neighbours, with the slope (v_{i+1} − v_{i−1})/(φ_{i+1} − φ_{i−1}) in
    a knot and the one-sided slope in the first and last.
    """
    at = np.array([knot[0] for knot in knots])
    value = np.array([knot[1] for knot in knots])
    if len(knots) == 1:
        return np.full_like(phases, value[0])
    after = np.minimum(np.arange(len(at)) + 1, len(at) - 1)
    before = np.maximum(np.arange(len(at)) - 1, 0)
    slope = (value[after] - value[before]) / (at[after] - at[before])
    inside = np.clip(phases, at[0], at[-1])
    i = np.clip(np.searchsorted(at, inside, side="right") - 1, 0, len(at) - 2)
    width = at[i + 1] - at[i]
    t = (inside - at[i]) / width
    result: Floats = (
        (1 + 2 * t) * (1 - t) ** 2 * value[i]
        + t * (1 - t) ** 2 * width * slope[i]
        + t * t * (3 - 2 * t) * value[i + 1]
        + t * t * (t - 1) * width * slope[i + 1]
    )
    return result


def tabulated(curves: Sequence[Knots], end_phase: float) -> Floats:
    """Values of curves at phases from 0 to `end_phase`, shape (SAMPLES, curves)."""
    phases = np.linspace(0.0, end_phase, SAMPLES)
    return np.stack([catmull_rom(knots, phases) for knots in curves], axis=1)


class CurveTable:
    """Several curves tabulated over the phase, all evaluated by one interpolation."""

    def __init__(self, curves: Sequence[Knots], end_phase: float) -> None:
        """Tabulate curves from phase 0 to `end_phase`; they are held constant beyond."""
        self._fill(tabulated(curves, end_phase), end_phase)

    @classmethod
    def of(cls, table: Floats, end_phase: float) -> "CurveTable":
        """Curves that `tabulated` has made, or a mix of such."""
        curves = cls.__new__(cls)
        curves._fill(table, end_phase)
        return curves

    def _fill(self, table: Floats, end_phase: float) -> None:
        self._table: list[list[float]] = table.tolist()
        self._scale = (SAMPLES - 1) / end_phase

    def at(self, phase: float) -> list[float]:
        """Values of all curves at a phase."""
        place = min(max(phase * self._scale, 0.0), SAMPLES - 1.000001)
        low = int(place)
        t = place - low
        rest = 1.0 - t
        pairs = zip(self._table[low], self._table[low + 1], strict=True)
        return [rest * a + t * b for a, b in pairs]
