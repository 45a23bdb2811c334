"""Quaternions (w, x, y, z) as the estimators need them, on MuJoCo's C functions."""

import math

import mujoco
import numpy as np

from hil.interface import Floats


def turned(orientation: Floats, rotation: Floats) -> Floats:
    """Orientation after a rotation vector [rad] in its own axes, shape (4,)."""
    result = orientation.copy()
    mujoco.mju_quatIntegrate(result, rotation, 1.0)
    return result


def difference(target: Floats, orientation: Floats) -> Floats:
    """Rotation vector in axes of `orientation` that turns it into `target` [rad], shape (3,)."""
    result = np.empty(3)
    mujoco.mju_subQuat(result, target, orientation)
    return result


def from_matrix(rotation: Floats) -> Floats:
    """Quaternion of a rotation matrix of shape (3, 3)."""
    result = np.empty(4)
    mujoco.mju_mat2Quat(result, np.ascontiguousarray(rotation).ravel())
    return result


def to_matrix(orientation: Floats) -> Floats:
    """Rotation matrix of a quaternion, shape (3, 3)."""
    result = np.empty(9)
    mujoco.mju_quat2Mat(result, orientation)
    return result.reshape(3, 3)


def about_vertical(angle: float) -> Floats:
    """Quaternion of a rotation about z by an angle [rad]."""
    return np.array([math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)])


def product(first: Floats, second: Floats) -> Floats:
    """Quaternion of `second`, then `first`."""
    result = np.empty(4)
    mujoco.mju_mulQuat(result, first, second)
    return result


def yaw(orientation: Floats) -> float:
    """Heading of the x axis in the horizontal plane [rad], −π to π."""
    w, x, y, z = orientation.tolist()
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
