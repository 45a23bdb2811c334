"""The surface of boxes, capsules and spheres as flat elements, in the frame of a body.

Seed 003_73fecd8ec8927aad, section 4: a decomposition of each limb's surface into finite elements,
since the velocity varies along the limb.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from hil.interface import Floats
from hil.solids import BOX, CAPSULE


@dataclass(frozen=True, slots=True)
class Surface:
    """Elements with their outward normals."""

    points: Floats
    """Centres [m], shape (k, 3)."""
    normals: Floats
    """Unit vectors, shape (k, 3)."""
    areas: Floats
    """[m²], shape (k,)."""


def body_surface(model: mujoco.MjModel, body: int, cell: float) -> Surface:
    """All geoms of a body in its inertial frame, in elements of about `cell` [m]."""
    points, normals, areas = [], [], []
    origin, axes = model.body_ipos[body], _matrix(model.body_iquat[body])
    for geom in np.flatnonzero(model.geom_bodyid == body):
        part = geom_surface(model, int(geom), cell)
        turn = axes.T @ _matrix(model.geom_quat[geom])
        points.append(part.points @ turn.T + (model.geom_pos[geom] - origin) @ axes)
        normals.append(part.normals @ turn.T)
        areas.append(part.areas)
    if not points:
        return Surface(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    return Surface(np.concatenate(points), np.concatenate(normals), np.concatenate(areas))


def geom_surface(model: mujoco.MjModel, geom: int, cell: float) -> Surface:
    """A box, a capsule or a sphere in its own frame."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom].tolist()
    if kind == BOX:
        return box_surface(size, cell)
    return round_surface(size[0], size[1] if kind == CAPSULE else 0.0, cell)


def box_surface(half_sizes: list[float], cell: float) -> Surface:
    """Six faces, each a regular grid."""
    points, normals, areas = [], [], []
    for axis in range(3):
        across = [i for i in range(3) if i != axis]
        counts = [max(1, math.ceil(2.0 * half_sizes[i] / cell)) for i in across]
        steps = [2.0 * half_sizes[i] / n for i, n in zip(across, counts, strict=True)]
        grid = [
            -half_sizes[i] + step * (np.arange(n) + 0.5)
            for i, n, step in zip(across, counts, steps, strict=True)
        ]
        first, second = (values.ravel() for values in np.meshgrid(*grid, indexing="ij"))
        for sign in (-1.0, 1.0):
            face, normal = np.zeros((first.size, 3)), np.zeros((first.size, 3))
            face[:, across[0]], face[:, across[1]] = first, second
            face[:, axis] = sign * half_sizes[axis]
            normal[:, axis] = sign
            points.append(face)
            normals.append(normal)
            areas.append(np.full(first.size, steps[0] * steps[1]))
    return Surface(np.concatenate(points), np.concatenate(normals), np.concatenate(areas))


def round_surface(radius: float, half_length: float, cell: float) -> Surface:
    """A sphere, or a capsule along z: rings of equal height on the caps, each 2πr·Δz in area."""
    bands = max(2, math.ceil(0.5 * math.pi * radius / cell))
    rises = (np.arange(bands) + 0.5) / bands
    rings = [(half_length + radius * z, float(z), 1.0 / bands) for z in rises]
    rings += [(-place, -z, height) for place, z, height in rings]
    if half_length > 0.0:
        count = math.ceil(2.0 * half_length / cell)
        height = 2.0 * half_length / count / radius
        middles = np.linspace(-half_length, half_length, 2 * count + 1)[1::2]
        rings += [(float(middle), 0.0, height) for middle in middles]
    points, normals, areas = [], [], []
    for place, z, height in rings:
        across = math.sqrt(1.0 - z * z)
        count = max(6, math.ceil(2.0 * math.pi * radius * across / cell))
        angles = 2.0 * math.pi * (np.arange(count) + 0.5) / count
        normal = np.column_stack(
            (across * np.cos(angles), across * np.sin(angles), np.full(count, z))
        )
        point = radius * normal
        point[:, 2] = place
        points.append(point)
        normals.append(normal)
        areas.append(np.full(count, 2.0 * math.pi * radius**2 * height / count))
    return Surface(np.concatenate(points), np.concatenate(normals), np.concatenate(areas))


def _matrix(quaternion: Floats) -> Floats:
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return matrix.reshape(3, 3)
