"""Boxes, capsules and spheres as cells of volume: what a liquid's level cuts through.

A solid is a fixed set of points, each with the volume of its cell, in the frame of its MuJoCo
geom, whose symmetry axis is z. The volumes of the slices of a round solid are exact.
"""

import itertools
import math
from dataclasses import dataclass

import mujoco
import numpy as np

from hil.errors import InputError
from hil.interface import Floats

SPHERE = int(mujoco.mjtGeom.mjGEOM_SPHERE)
CAPSULE = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
BOX = int(mujoco.mjtGeom.mjGEOM_BOX)
CAP_SLICES = 4
"""A half sphere has no fewer slices: the outermost one is the least even."""


@dataclass(frozen=True, slots=True)
class Solid:
    """Cells of one solid, in its own frame."""

    points: Floats
    """Centroids [m], shape (k, 3)."""
    volumes: Floats
    """[m³], shape (k,)."""
    half: Floats
    """Half sizes of a cell along x, y, z [m], shape (3,); of a mean cell where they differ."""


def solid(model: mujoco.MjModel, geom: int, cell: float) -> Solid:
    """Cells of about `cell` [m] of one geom. Raises InputError for any other shape."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom].tolist()
    if kind == BOX:
        return box_cells(size, cell)
    if kind in (SPHERE, CAPSULE):
        return round_cells(size[0], size[1] if kind == CAPSULE else 0.0, cell)
    raise InputError(
        f"geom {mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom)!r}: water needs boxes, "
        "capsules and spheres"
    )


def box_cells(half_sizes: list[float], cell: float) -> Solid:
    """A regular grid in a box of half sizes [m]."""
    counts = [max(1, math.ceil(2.0 * half / cell)) for half in half_sizes]
    half = np.array([size / count for size, count in zip(half_sizes, counts, strict=True)])
    axes = [
        np.linspace(-size + step, size - step, count)
        for size, step, count in zip(half_sizes, half, counts, strict=True)
    ]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return Solid(points, np.full(len(points), 8.0 * half.prod()), half)


def round_cells(radius: float, half_length: float, cell: float) -> Solid:
    """A sphere, or a capsule whose cylinder reaches ±half_length along z [m].

    Every slice across the axis becomes a disk of the slice's volume at the slice's centroid, cut
    into 4K² sectors of equal area on K rings.
    """
    points, volumes = [], []
    slices = _slices(radius, half_length, cell)
    for place, volume, thickness in slices:
        disk = _disk(math.sqrt(volume / (math.pi * thickness)), cell)
        points.append(np.column_stack((disk, np.full(len(disk), place))))
        volumes.append(np.full(len(disk), volume / len(disk)))
    along = 0.5 * sum(thickness for _, _, thickness in slices) / len(slices)
    cells = np.concatenate(volumes)
    across = 0.5 * math.sqrt(float(cells.mean()) / (2.0 * along))
    return Solid(np.concatenate(points), cells, np.array((across, across, along)))


def _slices(radius: float, half_length: float, cell: float) -> list[tuple[float, float, float]]:
    """Centroid along z [m], volume [m³] and thickness [m] of every slice, from below."""
    edges = np.linspace(0.0, radius, max(CAP_SLICES, math.ceil(radius / cell)) + 1)
    cap = []
    for low, high in itertools.pairwise(edges):
        volume = math.pi * (radius**2 * (high - low) - (high**3 - low**3) / 3.0)
        moment = radius**2 * (high**2 - low**2) / 2.0 - (high**4 - low**4) / 4.0
        cap.append((half_length + math.pi * moment / volume, volume, high - low))
    barrel = []
    if half_length > 0.0:
        count = math.ceil(2.0 * half_length / cell)
        thickness = 2.0 * half_length / count
        middles = np.linspace(-half_length, half_length, 2 * count + 1)[1::2]
        volume = math.pi * radius**2 * thickness
        barrel = [(float(middle), volume, thickness) for middle in middles]
    below = [(-place, volume, thickness) for place, volume, thickness in reversed(cap)]
    return below + barrel + cap


def _disk(radius: float, cell: float) -> Floats:
    """Centroids of the sectors of a disk [m], shape (4K², 2)."""
    rings = max(1, math.ceil(radius / cell))
    points = []
    for ring in range(1, rings + 1):
        count = 4 * (2 * ring - 1)
        inner, outer = radius * (ring - 1) / rings, radius * ring / rings
        half = math.pi / count
        place = (2.0 / 3.0) * (outer**3 - inner**3) / (outer**2 - inner**2)
        place *= math.sin(half) / half
        angles = half * (2.0 * np.arange(count) + 1.0)
        points.append(place * np.column_stack((np.cos(angles), np.sin(angles))))
    return np.concatenate(points)
