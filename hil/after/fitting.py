"""Least squares whose deviations come from leaving out parts of the record."""

import numpy as np

from hil.interface import Floats

BLOCKS = 8
"""Parts of a record that are left out in turn."""


def fit(table: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Solution of min |table·x − right| and its standard deviations, shape (columns,).

    Jackknife over blocks of neighbouring rows: steps of a walk are alike, samples of one step
    depend on each other, so that residuals alone would promise too much. Columns of zeros get
    the value 0.
    """
    block = np.arange(right.size) * BLOCKS // max(1, right.size)
    moments = [
        (table[block == b].T @ table[block == b], table[block == b].T @ right[block == b])
        for b in range(BLOCKS)
    ]
    squares, products = sum(m[0] for m in moments), sum(m[1] for m in moments)
    values = _solve(squares, products)
    others = np.array([_solve(squares - s, products - p) for s, p in moments])
    spread = np.square(others - others.mean(axis=0)).sum(axis=0)
    return values, np.sqrt(spread * (BLOCKS - 1) / BLOCKS)


def _solve(squares: Floats, products: Floats) -> Floats:
    scale = np.sqrt(np.diag(squares))
    scale[scale == 0.0] = 1.0
    scaled, *_ = np.linalg.lstsq(squares / np.outer(scale, scale), products / scale, rcond=1e-12)
    values: Floats = scaled / scale
    return values
