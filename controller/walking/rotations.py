"""Rotation matrices and rotation vectors, in batches."""

import math

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


def about_z(angle: float) -> Floats:
    """Rotation by an angle [rad] about z, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))


_POSITIVE = np.array([7, 2, 3])
_NEGATIVE = np.array([5, 6, 1])
"""Where a flattened matrix has the two halves of its skew part."""
_TINY = 1e-12
"""Below this sine θ/sin θ is 1."""


def rotation_vectors(rotations: Floats) -> Floats:
    """Logarithm of rotations of shape (k, 3, 3): axis times angle, shape (k, 3).

    With the skew part s = sin θ·axis and cos θ = (trace − 1)/2 the vector is s·θ/sin θ; the
    angle must stay below π.
    """
    flat = rotations.reshape(-1, 9)
    skew: Floats = 0.5 * (flat[:, _POSITIVE] - flat[:, _NEGATIVE])
    sine = np.sqrt(np.einsum("ij,ij->i", skew, skew))
    np.maximum(sine, _TINY, out=sine)
    cosine = 0.5 * (flat[:, 0] + flat[:, 4] + flat[:, 8] - 1.0)
    skew *= (np.arctan2(sine, cosine) / sine)[:, None]
    return skew


def small_rotation_vector(rotation: Floats) -> Floats:
    """Axis times sin θ of one rotation of shape (3, 3): its logarithm up to θ³/6, shape (3,)."""
    r = rotation
    return 0.5 * np.array((r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]))


def heading_of(rotation: Floats) -> float:
    """Yaw of a rotation's x axis about the vertical [rad]."""
    return math.atan2(float(rotation[1, 0]), float(rotation[0, 0]))
