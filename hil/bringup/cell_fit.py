"""Scales of the load cells of one foot from known weights, wherever on the sole they stood."""

from dataclasses import dataclass

import numpy as np

from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class CellFit:
    """What was found."""

    scale: Floats
    """[N/count], shape (4,); negative for a cell that counts down under load."""
    residual: float
    """Root mean square of the forces that are left over [N]."""


def fit_scales(counts: Floats, forces: Floats) -> CellFit:
    """Scales s that make every weight weigh what it weighs.

    counts: above zero, of all cells while a weight stood somewhere, shape (m, 4), m ≥ 4;
    forces: those weights [N], shape (m,). A sole on four cells shares a weight by where it stands,
    and only the sum is known:

        min Σ_i (Σ_c s_c·n_ic − F_i)²

    so a weight need not stand exactly on a cell. Raises ValueError where the placements do not
    tell four cells apart.
    """
    unit = np.abs(counts).max(axis=0)
    if not unit.all():
        raise ValueError("a cell never answered")
    scaled = counts / unit
    solution, _, rank, sizes = np.linalg.lstsq(scaled, forces, rcond=None)
    if rank < counts.shape[1] or sizes[-1] < _LEAST_SIZE * sizes[0]:
        raise ValueError("the weights stood too much on the same places")
    left = scaled @ solution - forces
    return CellFit(solution / unit, float(np.sqrt(np.mean(left**2))))


_LEAST_SIZE = 0.05
"""Least singular value, relative: placements that nearly repeat each other magnify noise."""
