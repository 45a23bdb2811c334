"""Swing leg: inverse kinematics from an ankle target to hip orientation and knee angle.

Seed 000_bd1305a0ae731442, section 3: the poses of the swing leg's joints come from the foot target
of the inverted pendulum model. Two links, closed form.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from controller.walking.rotations import small_rotation_vector
from controller.walking.torque_config import SwingLegConfig
from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class LegLinks:
    """Lengths of a leg's links [m] and the knee angle of its geometrically straight pose [rad]."""

    thigh: float
    shank: float
    knee_offset: float


def two_link(
    links: LegLinks,
    hip: Sequence[float],
    ankle: Sequence[float],
    lateral: Sequence[float],
    reach: float,
) -> tuple[Floats, float]:
    """World orientation of the thigh, shape (3, 3), and knee angle [rad] that reach an ankle.

    The hip-ankle distance is limited to `reach` of the straight leg. With sides a (thigh),
    b (shank) and distance L, the law of cosines gives the angle α between thigh and hip-ankle
    line and the flexion β: cos α = (a² + L² − b²)/(2aL), cos β = (L² − a² − b²)/(2ab). The knee
    axis is `lateral` made orthogonal to the hip-ankle line; the knee points forward. Plain numbers:
    on three of them array operations cost ten times as much.
    """
    a, b = links.thigh, links.shank
    x, y, z = ankle[0] - hip[0], ankle[1] - hip[1], ankle[2] - hip[2]
    distance = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / distance, y / distance, z / distance
    length = min(max(distance, 1.001 * abs(a - b) + 1e-3 * a), reach * (a + b))
    cosine = (a * a + length * length - b * b) / (2.0 * a * length)
    beta = math.acos((length * length - a * a - b * b) / (2.0 * a * b))
    alpha = math.acos(cosine)
    c, s = math.cos(alpha), math.sin(alpha)
    u, v, w = lateral
    along = u * x + v * y + w * z
    u, v, w = u - along * x, v - along * y, w - along * z
    size = math.sqrt(u * u + v * v + w * w)
    u, v, w = u / size, v / size, w / size
    ahead = (y * w - z * v, z * u - x * w, x * v - y * u)
    rotation = [
        (c * forward - s * down, axis, -c * down - s * forward)
        for forward, axis, down in zip(ahead, (u, v, w), (x, y, z), strict=True)
    ]
    return np.array(rotation), beta + links.knee_offset


class SwingLeg:
    """Targets of the swing hip and knee, with velocities by backward difference.

    ω*_hip = log(R*_k·R*_{k−1}ᵀ)/h in the pelvis frame and q̇*_knee = (q*_k − q*_{k−1})/h, each
    component within ± the rate limit; zero in the first tick of a step. The logarithm is that of
    small rotations: larger ones run into the limit.
    """

    def __init__(self, config: SwingLegConfig, links: LegLinks, dt: float) -> None:
        self._config = config
        self._links = links
        self._dt = dt
        self._last: tuple[Floats, float] | None = None
        self.hip = np.eye(3)
        """Thigh in the pelvis frame, shape (3, 3)."""
        self.hip_rate = (0.0, 0.0, 0.0)
        """In the pelvis frame [rad/s]."""
        self.knee = 0.0
        self.knee_rate = 0.0

    def begin_step(self) -> None:
        """Forget the other leg's targets."""
        self._last = None

    def update(
        self,
        hip: Sequence[float],
        ankle: Sequence[float],
        lateral: Sequence[float],
        pelvis: Floats,
    ) -> None:
        """Targets that bring the ankle to a world position, `pelvis` being its orientation."""
        thigh, self.knee = two_link(self._links, hip, ankle, lateral, self._config.reach)
        self.hip = pelvis.T @ thigh
        self.hip_rate = (0.0, 0.0, 0.0)
        self.knee_rate = 0.0
        if self._last is not None:
            limit, dt = self._config.rate_limit, self._dt
            x, y, z = small_rotation_vector(self.hip @ self._last[0].T)
            self.hip_rate = (
                min(max(x / dt, -limit), limit),
                min(max(y / dt, -limit), limit),
                min(max(z / dt, -limit), limit),
            )
            rate = (self.knee - self._last[1]) / dt
            self.knee_rate = min(max(rate, -limit), limit)
        self._last = (self.hip, self.knee)
