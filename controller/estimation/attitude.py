"""Attitude of the base: the IMU while it speaks, else a flat stance foot."""

import math
from collections.abc import Sequence

import numpy as np

from controller.estimation.config import EstimatorConfig
from controller.estimation.rotation import (
    about_vertical,
    difference,
    from_matrix,
    product,
    turned,
    yaw,
)
from hil.interface import Floats, SensorFrame


class AttitudeFilter:
    """Orientation q and angular velocity ω of the base.

    With an IMU: q ← q ⊗ exp(ω·dt), then q ← q ⊗ exp(g·log(q⁻¹ q_m)), where q_m is the measured
    orientation turned on by gyro·age, and g = 1 − e^(−dt/τ). The first orientation received
    defines heading 0. Without one: a stance foot lies flat, q = yaw(ψ_f) ⊗ (R_foot in base)ᵀ with
    ψ_f the heading that the foot had when it became the support, and ω is what keeps it at rest.
    """

    def __init__(self, config: EstimatorConfig, dt: float) -> None:
        self._dt = dt
        self._gain = 1.0 - math.exp(-dt / config.attitude_time)
        self._gyro_gain = 1.0 - math.exp(-dt / config.velocity_time)
        self._timeout_ns = round(config.imu_timeout * 1e9)
        self._heading_zero: Floats | None = None
        self._support = -1
        self._support_yaw = 0.0
        self.orientation: Floats = np.array([1.0, 0.0, 0.0, 0.0])
        """Base to world, (w, x, y, z)."""
        self.angular_velocity: Floats = np.zeros(3)
        """Base axes [rad/s]."""

    def hears_imu(self, frame: SensorFrame) -> bool:
        """Whether the IMU's last sample is recent enough to be used."""
        return frame.imu_present and frame.imu_age_ns <= self._timeout_ns

    def update_from_imu(self, frame: SensorFrame) -> None:
        """Take a recent IMU sample; an invalid frame only turns on with the last gyro."""
        self._support = -1
        if frame.imu_valid:
            self.angular_velocity += self._gyro_gain * (
                frame.imu_angular_velocity - self.angular_velocity
            )
        predicted = turned(self.orientation, self.angular_velocity * self._dt)
        if not frame.imu_valid:
            self.orientation = predicted
            return
        age = frame.imu_age_ns * 1e-9
        measured = turned(frame.imu_orientation, frame.imu_angular_velocity * age)
        if self._heading_zero is None:
            self._heading_zero = about_vertical(-yaw(measured))
            predicted = product(self._heading_zero, measured)
        measured = product(self._heading_zero, measured)
        correction = difference(measured, predicted)
        self.orientation = turned(predicted, self._gain * correction)

    def choose_support(self, loads: Sequence[float]) -> int:
        """The foot to hold flat: the present one until it carries less than a third."""
        present = self._support
        if present >= 0 and loads[present] > sum(loads) / 3.0:
            return present
        return loads.index(max(loads))

    def update_from_foot(self, support: int, rotation: Floats, angular_velocity: Floats) -> None:
        """Hold the support foot flat and still.

        `rotation` is that foot's orientation in base axes, shape (3, 3); `angular_velocity` its
        velocity against the base, in base axes [rad/s], from the joints alone.
        """
        in_base = from_matrix(rotation)
        if support != self._support:
            self._support = support
            self._support_yaw = yaw(product(self.orientation, in_base))
        inverse = in_base * np.array([1.0, -1.0, -1.0, -1.0])
        self.orientation = product(about_vertical(self._support_yaw), inverse)
        self.angular_velocity = -angular_velocity
