"""The IMU's constant tilt error, learnt from soles that lie flat on the ground."""

from collections.abc import Sequence

import numpy as np

from controller.estimation.config import TrimConfig
from hil.interface import Floats


class LevelTrim:
    """Rotation t in base axes that turns the IMU's attitude into one in which flat soles are level.

    A sole with three loaded corners on flat ground is level, so its upward axis u should be ẑ; with
    R the trimmed attitude, e = Rᵀ·(u × ẑ) is what is still missing, and t ← t + g·e over all ticks
    with a flat, loaded foot. g = max(1/n, dt/τ) in the n-th such tick: the mean while the robot
    stands at first, a slow filter in walking. The error of a mounted sensor is constant in base
    axes, and so is that of a joint zero.
    """

    def __init__(self, config: TrimConfig, weight: float, dt: float) -> None:
        self._least_gain = dt / config.time
        self._bound = config.bound
        self._corner = config.corner_load * weight
        self._foot = config.foot_load * weight
        self._ticks = 0
        self.rotation: Floats = np.zeros(3)
        """t [rad], base axes, shape (3,)."""

    def update(
        self, attitude: Floats, feet: Sequence[Floats], corners: Sequence[Sequence[float]]
    ) -> None:
        """Learn from one tick: trimmed attitude (3, 3), foot orientations, (3, 3) each, all to the
        world, and filtered corner forces [N], four a foot."""
        count, up_x, up_y = 0, 0.0, 0.0
        for foot, forces in zip(feet, corners, strict=True):
            if self._lies_flat(forces):
                x, y, _ = foot[:, 2].tolist()
                count, up_x, up_y = count + 1, up_x + x, up_y + y
        if not count:
            return
        self._ticks += 1
        gain = max(1.0 / self._ticks, self._least_gain) / count
        first, second, _ = attitude.tolist()
        bound = self._bound
        self.rotation[:] = [
            max(-bound, min(t + gain * (up_y * a - up_x * b), bound))
            for t, a, b in zip(self.rotation.tolist(), first, second, strict=True)
        ]

    def _lies_flat(self, forces: Sequence[float]) -> bool:
        corner = self._corner
        if sum(forces) <= self._foot:
            return False
        a, b, c, d = forces
        return (a > corner) + (b > corner) + (c > corner) + (d > corner) >= 3
