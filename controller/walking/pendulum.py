"""The linear inverted pendulum of a step: capture point, its steady motion, its prediction.

Symbols: x com from the stance ankle, v its velocity, ξ = x + v/ω the capture point, p the centre
of pressure, ω = √(g/h) with h the com height above the sole (above the ankle ω comes out 9 % too
high for a small robot, which then falls sideways within seconds). Sagittal and lateral alike.
"""

import math
from dataclasses import dataclass


@dataclass(slots=True)
class Pendulum:
    """One axis of ẍ = ω²(x − p), whose capture point obeys ξ̇ = ω(ξ − p)."""

    omega: float
    """[1/s]"""
    period: float
    """Nominal step time T [s]."""

    @property
    def growth(self) -> float:
        """Factor e^(ωT) by which ξ grows in a nominal step with p = 0."""
        return math.exp(self.omega * self.period)

    def steady_start(self, speed: float, half_sway: float) -> float:
        """ξ at the start of a step of the steady walk [m].

        b = V·T/(e^(ωT) − 1) + s/(1 + e^(ωT)): the first part repeats with every step at the mean
        speed V, the second alternates with the stance side; s is the step width, signed towards
        the swing side.
        """
        growth = self.growth
        return speed * self.period / (growth - 1.0) + half_sway / (1.0 + growth)

    def predict(self, capture_point: float, pressure: float, time: float) -> float:
        """ξ after a time with constant p [m]."""
        return pressure + (capture_point - pressure) * math.exp(self.omega * time)

    def time_to(self, capture_point: float, pressure: float, goal: float) -> float | None:
        """Time until ξ is at the goal with constant p [s]; none when it moves away from it."""
        here, there = capture_point - pressure, goal - pressure
        if here * there <= 0.0:
            return None
        return math.log(there / here) / self.omega
