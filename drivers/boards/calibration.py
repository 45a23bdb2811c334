"""From raw board counts to SI: load-cell zero and scale, IMU mounting."""

import math
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from drivers.boards.frames import (
    ACCELERATION_UNIT,
    ALL_CELLS,
    GYRO_UNIT,
    ORIENTATION_UNIT,
    FootFrame,
    ImuFrame,
    ImuStatus,
)
from hil.interface import Floats
from hil.validation import Config

_ORIENTATION = int(ImuStatus.ORIENTATION)
_GYRO = int(ImuStatus.GYRO)
_ACCELEROMETER = int(ImuStatus.ACCELEROMETER)
_LEAST_NORM = 0.5
"""A shorter quaternion is no orientation, whatever the status says."""

FourFloats = Annotated[tuple[float, ...], Field(min_length=4, max_length=4)]
ThreeFloats = Annotated[tuple[float, ...], Field(min_length=3, max_length=3)]


class FootCalibration(Config):
    """Load cells of one foot: force = scale·(counts − zero), corner by corner."""

    zero: FourFloats
    """Counts without load, corners in interface order."""
    scale: FourFloats
    """[N/count]; negative for a cell that counts down in compression."""

    @model_validator(mode="after")
    def _no_zero_scale(self) -> "FootCalibration":
        if 0.0 in self.scale:
            raise ValueError("scale must not be 0: the cell would be blind")
        return self


class ImuCalibration(Config):
    """How the IMU sits on the root body."""

    mounting: FourFloats = (1.0, 0.0, 0.0, 0.0)
    """Sensor axes to base axes (w, x, y, z)."""
    gyro_bias: ThreeFloats = (0.0, 0.0, 0.0)
    """What the gyro says at rest, in its own axes [rad/s]."""

    @model_validator(mode="after")
    def _unit_quaternion(self) -> "ImuCalibration":
        if abs(sum(c * c for c in self.mounting) - 1) > 1e-3:
            raise ValueError(
                f"mounting must be a unit quaternion (w, x, y, z), got {self.mounting}"
            )
        return self


class FootConverter:
    """Applies a FootCalibration."""

    def __init__(self, calibration: FootCalibration) -> None:
        self._zero = np.array(calibration.zero)
        self._scale = np.array(calibration.scale)

    def convert(self, frame: FootFrame, force: Floats) -> None:
        """Write corner forces [N] into `force`, shape (4,); invalid cells keep theirs."""
        fresh = (np.array(frame.counts) - self._zero) * self._scale
        if frame.status & ALL_CELLS == ALL_CELLS:
            force[:] = fresh
        else:
            np.copyto(force, fresh, where=[bool(frame.status >> cell & 1) for cell in range(4)])


class ImuConverter:
    """Applies an ImuCalibration: turns sensor axes into base axes.

    With the mounting M (sensor to base) and the board's orientation S (sensor to world), the
    base's orientation is S·M⁻¹ and vectors are turned by M; the gyro's bias is taken off.
    """

    def __init__(self, calibration: ImuCalibration) -> None:
        mounting = np.array(calibration.mounting)
        mounting /= np.linalg.norm(mounting)
        rotation = _matrix(mounting)
        self._all = np.zeros((10, 10))
        """Board counts to base values, the three parts of a frame at once."""
        self._rotation = rotation
        self.set_gyro_bias(np.array(calibration.gyro_bias))
        self._all[:4, :4] = ORIENTATION_UNIT * _right_product(mounting * [1, -1, -1, -1])
        self._all[4:7, 4:7] = GYRO_UNIT * rotation
        self._all[7:, 7:] = ACCELERATION_UNIT * rotation

    def set_gyro_bias(self, bias: Floats) -> None:
        """What the gyro says at rest from now on, in its own axes [rad/s], shape (3,)."""
        self._gyro_bias: Floats = self._rotation @ bias

    def convert(
        self, frame: ImuFrame, orientation: Floats, gyro: Floats, acceleration: Floats
    ) -> None:
        """Write (w, x, y, z), [rad/s] and [m/s²] in base axes; invalid parts keep theirs."""
        values = self._all @ (*frame.orientation, *frame.gyro, *frame.acceleration)
        status = frame.status
        if status & _ORIENTATION:
            quaternion = values[:4]
            norm = math.sqrt(quaternion @ quaternion)
            if norm > _LEAST_NORM:
                np.divide(quaternion, norm, out=orientation)
        if status & _GYRO:
            np.subtract(values[4:7], self._gyro_bias, out=gyro)
        if status & _ACCELEROMETER:
            acceleration[:] = values[7:]


def _matrix(q: Floats) -> Floats:
    """Rotation matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _right_product(q: Floats) -> Floats:
    """Matrix that multiplies a quaternion by q from the right."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, z, -y], [y, -z, w, x], [z, y, -x, w]])
