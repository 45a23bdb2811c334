"""Heat of servos: copper loss through winding and case to the air, and the copper's resistance."""

import numpy as np

from hil.interface import Floats

AMBIENT = 25.0
"""[°C]"""
WINDING_CAPACITY = 1.0
"""[J/K]; assumed: a few grams of copper, 6 s together with the resistance below."""
WINDING_RESISTANCE = 6.0
"""Winding to case [K/W]; assumed, as data sheets of coreless motors of 16 mm have it."""
CASE_CAPACITY = 80.0
"""[J/K]; assumed: 82 g at 1 J/(g·K)."""
CASE_RESISTANCE = 5.0
"""Case to air [K/W]; assumed. With the capacity, a time constant of 400 s."""
COPPER = 0.00393
"""Rise of copper's resistance [1/K], at 20 °C (IEC 60028)."""


class ServoHeat:
    """Two thermal masses a servo:

        C_w·Ṫ_w = r·i² − (T_w − T_c)/R_wc,   C_c·Ṫ_c = (T_w − T_c)/R_wc − (T_c − T_a)/R_ca
        r = r₂₅·(1 + α·(T_w − 25 °C))

    All thermal figures are assumed; magnets stay as strong as they are. Present Temperature is
    that of the case (assumed).
    """

    def __init__(self, resistance: Floats, size: Floats | None = None) -> None:
        """`resistance`: of the windings at 25 °C [Ω], (n,). `size`: of each servo against the one
        of 82 g whose figures these are, (n,): C goes with it, R with its inverse.
        """
        self._cold = resistance
        self._size = 1.0 if size is None else size
        self.resistance = resistance.copy()
        """As warm as the windings are [Ω], shape (n,)."""
        self.winding = np.full(resistance.size, AMBIENT)
        """[°C], shape (n,)."""
        self.case = np.full(resistance.size, AMBIENT)
        """[°C], shape (n,)."""
        self.highest = AMBIENT
        """Of any case so far [°C]."""

    def advance(self, mean_square: Floats, duration: float) -> None:
        """Mean square of the currents [A²], (n,), during some milliseconds [s]."""
        loss = self.resistance * mean_square / self._size
        inward = (self.winding - self.case) / WINDING_RESISTANCE
        outward = (self.case - AMBIENT) / CASE_RESISTANCE
        self.winding += duration / WINDING_CAPACITY * (loss - inward)
        self.case += duration / CASE_CAPACITY * (inward - outward)
        self.resistance = self._cold * (1.0 + COPPER * (self.winding - AMBIENT))
        self.highest = max(self.highest, float(self.case.max()))
