"""Closed-form kinematics of a six-joint leg with meeting hip axes and meeting ankle axes."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats

REACH = 0.999
"""A target beyond this share of the straight leg is moved in: the knee must not lock."""


@dataclass(frozen=True, slots=True)
class LegGeometry:
    """Joints in order: hip yaw (z), roll (x) and pitch (y), knee (y), ankle pitch (y) and roll (x).

    With u the hip seen from the ankle in foot axes and a, b the lengths of thigh and shank:
    ankle roll = atan2(u_y, u_z) puts the hip into the plane of the pitch axes; the knee follows
    from |u|² = a² + b² + 2ab·cos(knee); ankle pitch = atan2(−a·sin knee, b + a·cos knee)
    − atan2(u_x, √(u_y² + u_z²)); the hip angles are the yaw-roll-pitch angles of what remains.
    For a hip below the ankle (u_z < 0) both atan2 take the other branch: roll stays within ±π/2.
    """

    thigh: float
    """[m]"""
    shank: float
    """[m]"""

    @classmethod
    def of(cls, model: RobotModel) -> "LegGeometry":
        """The leg of a robot, read from its model."""
        return cls(model.thigh_length, model.shank_length)

    def solve(self, ankle: Sequence[float], foot: Sequence[Sequence[float]]) -> list[float]:
        """The six joint angles [rad].

        `ankle` is the ankle point seen from the hip centre in base axes [m], 3 numbers; `foot` the
        orientation of the foot in base axes, 3 rows of 3. Plain numbers: six solutions of a tick
        cost a third of what array operations on them would.
        """
        px, py, pz = ankle
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = foot
        x = -(px * r00 + py * r10 + pz * r20)
        y = -(px * r01 + py * r11 + pz * r21)
        z = -(px * r02 + py * r12 + pz * r22)
        thigh, shank = self.thigh, self.shank
        above_squared = y * y + z * z
        squared = min(x * x + above_squared, (REACH * (thigh + shank)) ** 2)
        cosine = (squared - thigh * thigh - shank * shank) / (2.0 * thigh * shank)
        knee = math.acos(max(-1.0, min(cosine, 1.0)))
        side = math.copysign(1.0, z)
        ankle_roll = math.atan2(side * y, side * z)
        lean = math.atan2(x, side * math.sqrt(above_squared))
        bend = math.atan2(-thigh * math.sin(knee), shank + thigh * math.cos(knee))
        ankle_pitch = bend - lean
        c, s = math.cos(ankle_roll), math.sin(ankle_roll)
        hip_yaw = math.atan2(r02 * s - r01 * c, r11 * c - r12 * s)
        hip_roll = math.asin(max(-1.0, min(r21 * c - r22 * s, 1.0)))
        pitch = math.atan2(-r20, r21 * s + r22 * c)
        hip_pitch = math.remainder(pitch - knee - ankle_pitch, math.tau)
        return [hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll]


def yaw_rotation(angle: float) -> Floats:
    """Rotation about z, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
