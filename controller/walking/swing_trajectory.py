"""Path of the swing foot over the phase of a step."""

import math
from dataclasses import dataclass

from controller.walking.heading_frame import Pair
from controller.walking.servo_config import SwingConfig


@dataclass(frozen=True, slots=True)
class SwingTrajectory:
    """A trapezoid of speed from lift-off to the landing point, a raised cosine in height.

    Horizontal: start + (target − start)·s(φ/φ_l) with a speed s' that rises for a share r of the
    way's time, stays, and falls for r: peak 1/(1 − r) and acceleration 1/(r(1 − r)), 1.25 and
    6.3 at r = 0.2, where minimum jerk has 1.9 and 5.8: it is speed that hips lack. The foot rests
    above its landing point from φ_l on.

    Height, with α = 2πφ: H(1 − cos α + a(1 − cos 3α)/3)/(2 + 2a/3) up to φ = 1, whose speed
    sin α + a·sin 3α is flatter than a sine and so asks for a slower knee (a = 0.2: −20 %); after
    φ = 1 down through the ground at v_s until contact is felt.
    """

    config: SwingConfig
    """H = height, a = flatness, φ_l = landing_phase, r = ramp, v_s = search_speed."""

    def horizontal(self, phase: float, start: Pair, target: Pair) -> Pair:
        """Place at a phase between two points [m]."""
        u = min(max(phase / self.config.landing_phase, 0.0), 1.0)
        share = self._travelled(u)
        (x, y), (to_x, to_y) = start, target
        return x + share * (to_x - x), y + share * (to_y - y)

    def _travelled(self, u: float) -> float:
        """s(u), from 0 to 1."""
        r = self.config.ramp
        top = 1.0 / (1.0 - r)
        if u < r:
            return 0.5 * top * u * u / r
        if u > 1.0 - r:
            return 1.0 - 0.5 * top * (1.0 - u) ** 2 / r
        return top * (u - 0.5 * r)

    def lift(self, phase: float, period: float) -> float:
        """Height above the ground at a phase [m]; `period` is 1/φ̇ [s]."""
        angle, a = math.tau * min(phase, 1.0), self.config.flatness
        wave = 1.0 - math.cos(angle) + a / 3.0 * (1.0 - math.cos(3.0 * angle))
        raised = self.config.height * wave / (2.0 + a * 2.0 / 3.0)
        return raised - self.config.search_speed * period * max(phase - 1.0, 0.0)
