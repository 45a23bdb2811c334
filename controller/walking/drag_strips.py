"""Limbs as strips, each with one speed and one drag: for a controller that reckons drag."""

import math

import mujoco
import numpy as np

from hil.interface import Floats
from hil.solids import BOX, CAPSULE


def strips(model: mujoco.MjModel, geom: int, length: float) -> tuple[Floats, Floats]:
    """Centres [m] and areas [m²] of a box's, capsule's or sphere's strips, both (k, 3).

    In the axes of the geom, cut along its longest one into strips of about `length` [m]. The
    areas are those that a strip shows along x, y and z: moving at u it shows √Σ(A_i·u_i)²/|u|,
    exact for the side of a cylinder and for a sphere, and for a box along its axes; in between a
    box shows more, by √3 at most.
    """
    kind, size = int(model.geom_type[geom]), model.geom_size[geom].tolist()
    if kind == BOX:
        return _box(size, length)
    return _round(size[0], size[1] if kind == CAPSULE else 0.0, length)


def _box(half: list[float], length: float) -> tuple[Floats, Floats]:
    """Slices of a box; its two ends show their area by halves, since only one meets the liquid."""
    axis = int(np.argmax(half))
    a, b = (i for i in range(3) if i != axis)
    count = max(2, math.ceil(2.0 * half[axis] / length))
    height = 2.0 * half[axis] / count
    points, areas = np.zeros((count, 3)), np.zeros((count, 3))
    points[:, axis] = height * (np.arange(count) + 0.5) - half[axis]
    areas[:, a], areas[:, b] = 2.0 * half[b] * height, 2.0 * half[a] * height
    areas[[0, -1], axis] = 2.0 * half[a] * half[b]
    return points, areas


def _round(radius: float, half_length: float, length: float) -> tuple[Floats, Floats]:
    """Slices of a cylinder along z and its two caps, each half a sphere's area any way it moves."""
    count = math.ceil(2.0 * half_length / length)
    points = np.zeros((count + 2, 3))
    areas = np.full((count + 2, 3), 0.5 * math.pi * radius**2)
    if count:
        height = 2.0 * half_length / count
        points[1:-1, 2] = height * (np.arange(count) + 0.5) - half_length
        areas[1:-1] = (2.0 * radius * height, 2.0 * radius * height, 0.0)
    points[[0, -1], 2] = -half_length - 0.375 * radius, half_length + 0.375 * radius
    return points, areas
