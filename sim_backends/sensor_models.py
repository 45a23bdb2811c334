"""How sensors err: seeded biases drawn once, white noise drawn for every sample.

Samples are a handful of numbers, for which lists of floats are faster than arrays.
"""

import math

import numpy as np

from hil.description import Noise
from hil.interface import Floats

_BLOCK = 64
"""Samples of white noise drawn at once: many, so that drawing is cheap, but not so many that a
robot in real time would answer late because of it."""

ImuSample = tuple[list[float], list[float], list[float]]
"""Orientation (w, x, y, z), angular velocity [rad/s] and specific force [m/s²], in base axes."""


class WhiteNoise:
    """Independent normal samples of fixed standard deviations, from a stream of its own."""

    def __init__(self, random: np.random.Generator, deviation: Floats) -> None:
        """The stream is a child of `random`, from which nothing is drawn."""
        (self._random,) = random.spawn(1)
        self._deviation = deviation
        self._rows: list[list[float]] = []

    def sample(self) -> list[float]:
        """One value for each standard deviation."""
        if not self._rows:
            block = self._random.standard_normal((_BLOCK, self._deviation.size))
            self._rows = (block * self._deviation).tolist()
        return self._rows.pop()


class ImuErrors:
    """Errors of one inertial measurement unit.

    Orientation: q·δ(b + w) with a constant roll and pitch error b and white noise w about the
    base axes; angular velocity: ω + b + w; specific force: f + w. All from `Noise`.
    """

    def __init__(self, noise: Noise, random: np.random.Generator) -> None:
        self._tilt: list[float] = random.normal(0.0, noise.attitude_bias, 2).tolist()
        self._gyro_bias: list[float] = random.normal(0.0, noise.gyro_bias, 3).tolist()
        deviation = np.repeat([noise.attitude, noise.gyro, noise.accelerometer], 3)
        self._white = WhiteNoise(random, deviation)

    def measure(
        self, orientation: Floats, angular_velocity: Floats, specific_force: Floats
    ) -> ImuSample:
        """A sample of the true (w, x, y, z), (3,) [rad/s] and (3,) [m/s²], all in base axes."""
        ex, ey, ez, *white = self._white.sample()
        x, y, z = 0.5 * (self._tilt[0] + ex), 0.5 * (self._tilt[1] + ey), 0.5 * ez
        gyro = [
            rate + bias + error
            for rate, bias, error in zip(
                angular_velocity.tolist(), self._gyro_bias, white[:3], strict=True
            )
        ]
        force = [f + error for f, error in zip(specific_force.tolist(), white[3:], strict=True)]
        return _turned(orientation.tolist(), x, y, z), gyro, force


def _turned(q: list[float], x: float, y: float, z: float) -> list[float]:
    """The unit quaternion along q·(1, x, y, z)."""
    a, b, c, d = q
    w, i = a - b * x - c * y - d * z, b + a * x + c * z - d * y
    j, k = c + a * y - b * z + d * x, d + a * z + b * y - c * x
    scale = 1.0 / math.sqrt(w * w + i * i + j * j + k * k)
    return [w * scale, i * scale, j * scale, k * scale]


class CellErrors:
    """Errors of load cells: a zero that calibration left behind, and white noise."""

    def __init__(self, noise: Noise, random: np.random.Generator, cells: int) -> None:
        self.zero: Floats = random.normal(0.0, noise.corner_zero, cells)
        """Constant error of each cell [N]."""
        self._white = WhiteNoise(random, np.full(cells, noise.corner_force))

    def measure(self, force: list[float]) -> list[float]:
        """A sample of the true forces [N], without the constant error."""
        return [f + error for f, error in zip(force, self._white.sample(), strict=True)]
