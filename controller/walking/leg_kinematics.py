"""Closed-form kinematics of a six-joint leg with meeting hip axes and meeting ankle axes."""

from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats

REACH = 0.999
"""A target beyond this share of the straight leg is moved in: the knee must not lock."""


@dataclass(frozen=True, slots=True)
class LegGeometry:
    """Joint order hip yaw (z), hip roll (x), hip pitch (y), knee (y), ankle pitch (y), ankle roll (x).

    With u the hip seen from the ankle in foot axes and a, b the lengths of thigh and shank:
    ankle roll = atan2(u_y, u_z) puts the hip into the plane of the pitch axes; the knee follows
    from |u|² = a² + b² + 2ab·cos(knee); ankle pitch = atan2(−a·sin knee, b + a·cos knee)
    − atan2(u_x, √(u_y² + u_z²)); the hip angles are the yaw-roll-pitch angles of what remains.
    """

    thigh: float
    """[m]"""
    shank: float
    """[m]"""

    @classmethod
    def of(cls, model: RobotModel) -> "LegGeometry":
        """The leg of a robot, read from its model."""
        return cls(model.thigh_length, model.shank_length)

    def solve(self, ankle: Floats, foot: Floats) -> Floats:
        """Joint angles [rad], shape (..., 6).

        `ankle` is the ankle point seen from the hip centre in base axes [m], shape (..., 3);
        `foot` the orientation of the foot in base axes, shape (..., 3, 3).
        """
        thigh, shank = self.thigh, self.shank
        seen = -np.matmul(ankle[..., None, :], foot)[..., 0, :]
        x, y, z = seen[..., 0], seen[..., 1], seen[..., 2]
        height_squared = y * y + z * z
        squared = np.minimum(x * x + height_squared, (REACH * (thigh + shank)) ** 2)
        cosine = (squared - thigh * thigh - shank * shank) / (2 * thigh * shank)
        knee = np.arccos(np.clip(cosine, -1.0, 1.0))
        side = np.copysign(1.0, z)
        ankle_roll = np.arctan2(side * y, side * z)
        lean = np.arctan2(x, side * np.sqrt(height_squared))
        ankle_pitch = np.arctan2(-thigh * np.sin(knee), shank + thigh * np.cos(knee)) - lean
        c, s = np.cos(ankle_roll)[..., None], np.sin(ankle_roll)[..., None]
        lateral = foot[..., 1] * c - foot[..., 2] * s
        upward = foot[..., 2, 1] * s[..., 0] + foot[..., 2, 2] * c[..., 0]
        pitch = np.arctan2(-foot[..., 2, 0], upward)
        hip_yaw = np.arctan2(-lateral[..., 0], lateral[..., 1])
        hip_roll = np.arcsin(np.clip(lateral[..., 2], -1.0, 1.0))
        hip_pitch = pitch - knee - ankle_pitch
        hip_pitch -= 2 * np.pi * np.round(hip_pitch / (2 * np.pi))
        return np.stack([hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll], axis=-1)


def yaw_rotation(angle: float) -> Floats:
    """Rotation about z, shape (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
