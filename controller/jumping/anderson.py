"""Anderson's acceleration of an iteration that creeps towards its fixed point."""

import numpy as np

from hil.interface import Floats

MEMORY = 5
CUTOFF = 1e-8
"""Singular values below this share of the largest are left out."""


class Anderson:
    """From steps x → g(x), the point where a linear g would stand still.

    With residuals f = g(x) − x and the differences ΔF, ΔG of the last steps, the next point is
    g − ΔG·γ, γ = argmin |f − ΔF·γ| (Anderson 1965; Walker and Ni 2011).
    """

    def __init__(self) -> None:
        self._images: list[Floats] = []
        self._residuals: list[Floats] = []

    def next(self, point: Floats, image: Floats) -> Floats:
        """Where to go on after one step from `point` to `image`, each of shape (k,)."""
        residual = image - point
        self._images = [*self._images[-MEMORY:], image]
        self._residuals = [*self._residuals[-MEMORY:], residual]
        if len(self._images) == 1:
            return image
        differences = np.diff(np.array(self._residuals), axis=0).T
        shares = np.linalg.lstsq(differences, residual, rcond=CUTOFF)[0]
        forward: Floats = image - np.diff(np.array(self._images), axis=0).T @ shares
        return forward
