"""Path of the swing foot over the phase of a step."""

import math
from dataclasses import dataclass

from controller.walking.heading_frame import Pair
from controller.walking.servo_config import SwingConfig


@dataclass(frozen=True, slots=True)
class SwingTrajectory:
    """Minimum jerk from lift-off to the landing point, a raised cosine in height.

    Horizontal: start + (target − start)·s(φ/φ_l), s(u) = 10u³ − 15u⁴ + 6u⁵, so the foot rests
    above its landing point from φ_l on (a target still moving at touch-down makes joint-speed
    spikes). Height, with α = 2πφ: H(1 − cos α + a(1 − cos 3α)/3)/(2 + 2a/3) up to φ = 1, whose
    speed sin α + a·sin 3α is flatter than a sine and so asks for a slower knee (a = 0.2: −20 %);
    after φ = 1 down through the ground at v_s until contact is felt.
    """

    config: SwingConfig
    """H = height, a = flatness, φ_l = landing_phase, v_s = search_speed."""

    def horizontal(self, phase: float, start: Pair, target: Pair) -> Pair:
        """Place at a phase between two points [m]."""
        u = min(max(phase / self.config.landing_phase, 0.0), 1.0)
        share = u * u * u * (10.0 + u * (6.0 * u - 15.0))
        (x, y), (to_x, to_y) = start, target
        return x + share * (to_x - x), y + share * (to_y - y)

    def lift(self, phase: float, period: float) -> float:
        """Height above the ground at a phase [m]; `period` is 1/φ̇ [s]."""
        angle, a = math.tau * min(phase, 1.0), self.config.flatness
        wave = 1.0 - math.cos(angle) + a / 3.0 * (1.0 - math.cos(3.0 * angle))
        raised = self.config.height * wave / (2.0 + a * 2.0 / 3.0)
        return raised - self.config.search_speed * period * max(phase - 1.0, 0.0)
