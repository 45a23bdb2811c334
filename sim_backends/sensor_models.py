"""How sensors err: seeded biases drawn once, white noise drawn for every sample."""

import mujoco
import numpy as np

from hil.description import Noise
from hil.interface import Floats


class ImuErrors:
    """Errors of one inertial measurement unit.

    Orientation: q·δ(b + w) with a constant roll and pitch error b and white noise w about the
    base axes; angular velocity: ω + b + w; specific force: f + w. All from `Noise`.
    """

    def __init__(self, noise: Noise, random: np.random.Generator) -> None:
        self._random = random
        self._tilt = np.append(random.normal(0.0, noise.attitude_bias, 2), 0.0)
        self._gyro_bias = random.normal(0.0, noise.gyro_bias, 3)
        self._white = np.repeat([noise.attitude, noise.gyro, noise.accelerometer], 3)
        self._delta = np.array([1.0, 0.0, 0.0, 0.0])
        self._measured = np.empty(4)

    def measure(
        self, orientation: Floats, angular_velocity: Floats, specific_force: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """A sample of the true (w, x, y, z), (3,) [rad/s] and (3,) [m/s²], all in base axes."""
        white = self._random.standard_normal(9)
        white *= self._white
        self._delta[1:] = 0.5 * (self._tilt + white[:3])
        mujoco.mju_mulQuat(self._measured, orientation, self._delta)
        mujoco.mju_normalize4(self._measured)
        gyro = angular_velocity + self._gyro_bias
        gyro += white[3:6]
        return self._measured.copy(), gyro, specific_force + white[6:]


class CellErrors:
    """Errors of load cells: a zero that calibration left behind, and white noise."""

    def __init__(self, noise: Noise, random: np.random.Generator, shape: tuple[int, ...]) -> None:
        self._random = random
        self._white = noise.corner_force
        self.zero = random.normal(0.0, noise.corner_zero, shape)
        """Constant error of each cell [N]."""

    def measure(self, force: Floats) -> Floats:
        """A sample of the true forces [N], without the constant error."""
        sample = self._random.standard_normal(self.zero.shape)
        sample *= self._white
        sample += force
        return sample
