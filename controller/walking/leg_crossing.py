"""Leg crossing: the swing foot goes round the stance foot.

First author's code for seed 000_bd1305a0ae731442: a via point at a safe distance when the straight
path of the swing foot would cross the stance leg.
"""

from dataclasses import dataclass

from pydantic import NonNegativeFloat

from controller.walking.heading_frame import Pair
from hil.validation import Config


class LegCrossingConfig(Config):
    """How close the feet may pass."""

    clearance: NonNegativeFloat
    """Gap between the soles [m]; 0.02 in the author's code."""


@dataclass(frozen=True, slots=True)
class LegCrossing:
    """Path of the swing foot from its start to its landing point, past the stance ankle.

    All places are from the stance ankle, sagittal and coronal, σ = ±1 the swing side, s the part
    of the way. The straight path p(s) = a + s·(b − a) passes the ankle at s_v = −a_x/(b_x − a_x).
    Where σ·p_y(s_v) < c, c being clearance and sole width, it goes by the via point
    (p_x(s_v), σ·c): p_y is moved by (σ·c − p_y(s_v))·min(s/s_v, (1 − s)/(1 − s_v)). A path that
    starts inside c already, or does not pass the ankle, stays as it is.
    """

    distance: float
    """c, between the ankles [m]."""

    def sidestep(self, start: Pair, landing: Pair, share: float, side: int) -> float:
        """Coronal offset of the path [m] at the part `share` of the way, `side` = σ."""
        (ax, ay), (bx, by) = start, landing
        if ax >= 0.0 or bx <= 0.0 or side * ay <= self.distance:
            return 0.0
        via = ax / (ax - bx)
        missing = side * self.distance - (ay + via * (by - ay))
        if side * missing <= 0.0:
            return 0.0
        return missing * min(share / via, (1.0 - share) / (1.0 - via))
