"""How sensors err: seeded biases drawn once, white noise drawn for every sample.

Samples are a handful of numbers, for which lists of floats are faster than arrays.
"""

import math
from collections.abc import Collection

import numpy as np

from hil.description import RobotDescription
from hil.interface import CORNERS, Floats
from hil.twin import Noise

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
    base axes; angular velocity: ω + b + w; specific force: f + w. All from `Noise`. A unit that
    is mounted with a pitch θ measures in axes turned by θ about the base's y axis.
    """

    def __init__(self, noise: Noise, random: np.random.Generator, pitch: float = 0.0) -> None:
        """`pitch`: of the unit against the base [rad]."""
        self._half_pitch = (math.cos(0.5 * pitch), math.sin(0.5 * pitch)) if pitch else None
        self._turn = (math.cos(pitch), math.sin(pitch))
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
        quaternion, rates = orientation.tolist(), angular_velocity.tolist()
        forces = specific_force.tolist()
        if self._half_pitch is not None:
            quaternion = _pitched(quaternion, *self._half_pitch)
            rates, forces = self._mounted(rates), self._mounted(forces)
        gyro = [
            rate + bias + error
            for rate, bias, error in zip(rates, self._gyro_bias, white[:3], strict=True)
        ]
        force = [f + error for f, error in zip(forces, white[3:], strict=True)]
        return _turned(quaternion, x, y, z), gyro, force

    def _mounted(self, vector: list[float]) -> list[float]:
        """A vector in base axes, in those of the unit."""
        (x, y, z), (cos, sin) = vector, self._turn
        return [cos * x - sin * z, y, sin * x + cos * z]


def _pitched(q: list[float], cos: float, sin: float) -> list[float]:
    """The quaternion q·(cos, 0, sin, 0)."""
    a, b, c, d = q
    return [a * cos - c * sin, b * cos - d * sin, c * cos + a * sin, d * cos + b * sin]


def _turned(q: list[float], x: float, y: float, z: float) -> list[float]:
    """The unit quaternion along q·(1, x, y, z)."""
    a, b, c, d = q
    w, i = a - b * x - c * y - d * z, b + a * x + c * z - d * y
    j, k = c + a * y - b * z + d * x, d + a * z + b * y - c * x
    scale = 1.0 / math.sqrt(w * w + i * i + j * j + k * k)
    return [w * scale, i * scale, j * scale, k * scale]


class CellErrors:
    """Errors of load cells: a zero that calibration left behind, white noise, no signal at all."""

    def __init__(
        self,
        noise: Noise,
        random: np.random.Generator,
        cells: int,
        dead: Collection[int] = (),
    ) -> None:
        """`dead`: indices of cells whose bridge gives no signal."""
        self._gain = [0.0 if cell in dead else 1.0 for cell in range(cells)]
        self.zero: Floats = random.normal(0.0, noise.corner_zero, cells)
        """Constant error of each cell [N]."""
        self._white = WhiteNoise(random, np.full(cells, noise.corner_force))

    def measure(self, force: list[float]) -> list[float]:
        """A sample of the true forces [N], without the constant error."""
        return [
            gain * f + error
            for gain, f, error in zip(self._gain, force, self._white.sample(), strict=True)
        ]


def dead_cells(description: RobotDescription, side: str) -> set[int]:
    """Indices in `CORNERS` of one foot's cells that `plant.dead_cells` names."""
    names = [cell.split("_foot:") for cell in description.plant.dead_cells]
    return {CORNERS.index(corner) for foot, corner in names if foot == side}
