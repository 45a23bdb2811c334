"""The IMU's constant tilt error, learnt from soles that lie flat on the ground."""

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

    def update(self, attitude: Floats, feet: Floats, force: Floats) -> None:
        """Learn from one tick: trimmed attitude (3, 3), foot orientations (2, 3, 3), both to the
        world, and filtered corner forces [N], (2, 4)."""
        flat = (np.count_nonzero(force > self._corner, axis=1) >= 3) & (
            force.sum(axis=1) > self._foot
        )
        count = int(np.count_nonzero(flat))
        if not count:
            return
        self._ticks += 1
        upward = flat @ feet[:, :, 2] / count
        missing = np.array([upward[1], -upward[0], 0.0]) @ attitude
        gain = max(1.0 / self._ticks, self._least_gain)
        trimmed = self.rotation + gain * missing
        self.rotation = np.minimum(np.maximum(trimmed, -self._bound), self._bound)
