"""Closed-form kinematics of a six-joint leg with meeting hip axes and meeting ankle axes."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, asin, atan2, copysign, cos, remainder, sin, sqrt, tau

from controller.robot_model import RobotModel

Vector = tuple[float, float, float]
Rows = Sequence[Sequence[float]]
"""A rotation matrix as rows of plain numbers."""
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

    def solve(self, ankle: Sequence[float], foot: Rows) -> list[float]:
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
        squared, reach = x * x + above_squared, REACH * (thigh + shank)
        if squared > reach * reach:
            squared = reach * reach
        knee = acos(_unit((squared - thigh * thigh - shank * shank) / (2.0 * thigh * shank)))
        side = copysign(1.0, z)
        ankle_roll = atan2(side * y, side * z)
        lean = atan2(x, side * sqrt(above_squared))
        ankle_pitch = atan2(-thigh * sin(knee), shank + thigh * cos(knee)) - lean
        c, s = cos(ankle_roll), sin(ankle_roll)
        hip_yaw = atan2(r02 * s - r01 * c, r11 * c - r12 * s)
        hip_roll = asin(_unit(r21 * c - r22 * s))
        pitch = atan2(-r20, r21 * s + r22 * c)
        hip_pitch = remainder(pitch - knee - ankle_pitch, tau)
        return [hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll]


def _unit(value: float) -> float:
    """A sine or cosine that rounding may have moved beyond ±1."""
    return value if -1.0 <= value <= 1.0 else copysign(1.0, value)


def yaw_rows(angle: float) -> Rows:
    """Rotation about z."""
    c, s = cos(angle), sin(angle)
    return (c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)
