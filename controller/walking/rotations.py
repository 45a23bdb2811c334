"""Rotation matrices and rotation vectors, in batches."""

import math
from collections.abc import Sequence

import numpy as np

from hil.interface import Floats


def about_x(angle: float) -> Floats:
    """Rotation by an angle [rad] about x, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)))


def about_y(angle: float) -> Floats:
    """Rotation by an angle [rad] about y, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)))


def turn_about_y(rotation: Floats, angle: float) -> None:
    """Make a rotation about y of one that already is, shape (3, 3), one by `angle` [rad]."""
    rotation[0, 0] = rotation[2, 2] = math.cos(angle)
    rotation[0, 2] = sine = math.sin(angle)
    rotation[2, 0] = -sine


def turn_about_z(rotation: Floats, angle: float) -> None:
    """Make a rotation about z of one that already is, shape (3, 3), one by `angle` [rad]."""
    rotation[0, 0] = rotation[1, 1] = math.cos(angle)
    rotation[1, 0] = sine = math.sin(angle)
    rotation[0, 1] = -sine


def yaw_pitch_roll(yaw: float, pitch: float, roll: float) -> list[list[float]]:
    """Rows of R_z(yaw)·R_y(pitch)·R_x(roll), angles in rad."""
    cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    cr, sr = math.cos(roll), math.sin(roll)
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def about_z(angle: float) -> Floats:
    """Rotation by an angle [rad] about z, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))


def about_axis(axis: Sequence[float], angle: float) -> list[list[float]]:
    """Rows of the rotation by an angle [rad] about a unit vector a.

    cos·I + sin·[a]ₓ + (1 − cos)·a·aᵀ (Rodrigues).
    """
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    d = 1.0 - c
    return [
        [c + d * x * x, d * x * y - s * z, d * x * z + s * y],
        [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
        [d * x * z - s * y, d * y * z + s * x, c + d * z * z],
    ]


_SKEW_AND_TRACE = np.zeros((9, 4))
"""From a flattened matrix to half its skew part and half its trace."""
_SKEW_AND_TRACE[[7, 2, 3], [0, 1, 2]] = 0.5
_SKEW_AND_TRACE[[5, 6, 1], [0, 1, 2]] = -0.5
_SKEW_AND_TRACE[[0, 4, 8], 3] = 0.5
_TINY = 1e-12
"""Below this sine θ/sin θ is 1."""


def rotation_vectors(rotations: Floats) -> Floats:
    """Logarithm of rotations of shape (k, 3, 3): axis times angle, shape (k, 3).

    With the skew part s = sin θ·axis and cos θ = (trace − 1)/2 the vector is s·θ/sin θ; the
    angle must stay below π.
    """
    parts = rotations.reshape(-1, 9) @ _SKEW_AND_TRACE
    skew: Floats = parts[:, :3]
    sine = np.sqrt(np.vecdot(skew, skew))
    np.maximum(sine, _TINY, out=sine)
    factor = np.arctan2(sine, parts[:, 3] - 0.5)
    factor /= sine
    skew *= factor[:, None]
    return skew


def small_rotation_vector(rotation: Floats) -> tuple[float, float, float]:
    """Axis times sin θ of one rotation of shape (3, 3): its logarithm up to θ³/6."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = rotation.tolist()
    return 0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy)


def heading_of(rotation: Floats) -> float:
    """Yaw of a rotation's x axis about the vertical [rad]."""
    return math.atan2(float(rotation[1, 0]), float(rotation[0, 0]))
