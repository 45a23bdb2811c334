"""Foot contact from noisy corner forces: a filter, then two thresholds."""

import math

import numpy as np

from controller.estimation.config import ContactConfig
from controller.estimation.dead_cells import DeadCells
from hil.interface import Bools, Floats


class ContactDetector:
    """Filtered corner forces and a contact flag per foot.

    f ← f + (1 − e^(−dt/τ))·(measured − f); a foot gains contact when the sum of its corners
    exceeds `on`·W and loses it below `off`·W, W the body weight. Cells that read tension are
    taken as they are in the sum, so that zero-mean noise stays zero-mean. A measured cell without
    signal is replaced (`DeadCells`); the truth has none.
    """

    def __init__(
        self, config: ContactConfig, weight: float, dt: float, cells: DeadCells | None = None
    ) -> None:
        time = config.filter_time
        self._gain = 1.0 - math.exp(-dt / time) if time > 0.0 else 1.0
        self._on = config.on * weight
        self._off = config.off * weight
        self._cells = cells
        self._filtered: Floats = np.zeros((2, 4))
        self._change: Floats = np.zeros((2, 4))
        self.force: Floats = np.zeros((2, 4))
        """Filtered corner forces [N], dead cells replaced, shape (2, 4)."""
        self.contact: Bools = np.zeros(2, dtype=np.bool_)
        """Whether each foot is on the ground, shape (2,)."""
        self.corners: list[list[float]] = self.force.tolist()
        """`force` as plain numbers."""
        self.loads = [0.0, 0.0]
        """Sum of each foot's corners [N]."""

    def update(self, force: Floats) -> None:
        """Take the corner forces of one tick [N], shape (2, 4)."""
        change = self._change
        np.subtract(force, self._filtered, out=change)
        change *= self._gain
        self._filtered += change
        self.corners = self._filtered.tolist()
        if self._cells is not None:
            self.corners = [self._cells.repair(*foot) for foot in enumerate(self.corners)]
        self.force[:] = self.corners
        contact = self.contact
        for foot, (a, b, c, d) in enumerate(self.corners):
            load = self.loads[foot] = a + b + c + d
            contact[foot] = load > (self._off if contact[foot] else self._on)
