"""Path of the swing foot over the phase of a step."""

from dataclasses import dataclass

import numpy as np

from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class SwingTrajectory:
    """Minimum jerk from lift-off to the landing point, a raised cosine in height.

    Horizontal: start + (target − start)·s(φ/φ_l), s(u) = 10u³ − 15u⁴ + 6u⁵, so the foot rests
    above its landing point from φ_l on (a target still moving at touch-down makes joint-speed
    spikes). Height: H(1 − cos 2πφ)/2 up to φ = 1, then down through the ground at v_s until
    contact is felt.
    """

    height: float
    """H [m]."""
    landing_phase: float
    """φ_l."""
    search_speed: float
    """v_s [m/s]."""

    def horizontal(self, phase: Floats, start: Floats, target: Floats) -> Floats:
        """Points at phases of shape (k,), between points of shape (2,): shape (k, 2) [m]."""
        u = np.minimum(np.maximum(phase / self.landing_phase, 0.0), 1.0)
        share = u * u * u * (10.0 + u * (6.0 * u - 15.0))
        return start + share[:, None] * (target - start)

    def lift(self, phase: Floats, period: float) -> Floats:
        """Heights above the ground at phases of shape (k,) [m]; `period` is 1/φ̇ [s]."""
        raised = self.height * 0.5 * (1.0 - np.cos(2.0 * np.pi * np.minimum(phase, 1.0)))
        return raised - self.search_speed * period * np.maximum(phase - 1.0, 0.0)
