"""A floor that is not flat: under every corner of every sole its own height."""

import mujoco
import numpy as np

from hil.errors import InputError
from hil.interface import Floats
from sim_backends.draws import quantity_stream

CELL = 0.1
"""Distance of the points between which the floor is a ruled surface [m]; assumed."""
_POINTS = 64
"""Points of the pattern in x and in y, after which it repeats."""
_RADIUS = 1e-4
"""Of the feeler at a corner [m]."""
_CLEARANCE = 5e-4
"""A corner that far above its floor is in the air [m]."""
_FIRST_BIT = 8
"""First collision bit of the corners; lower ones belong to the MJCF."""
_PLANE, _FEELER = "floor_under_", "feeler_of_"


def add_feelers(spec: mujoco.MjSpec, soles: list[str], file: object) -> None:
    """Let every bottom corner of the box soles touch a floor of its own instead of the common one.

    A box touches a plane in its corners alone, so on equal heights nothing changes. Raises
    InputError for a sole that is no box.
    """
    planes = [g for g in spec.worldbody.geoms if g.type == mujoco.mjtGeom.mjGEOM_PLANE]
    names = [sole for sole in soles if spec.geom(sole).type != mujoco.mjtGeom.mjGEOM_BOX]
    if names or not planes:
        missing = f"sole {names[0]!r} is no box" if names else "it has no floor plane"
        raise InputError(f"{file}: an uneven floor wants box soles on a plane: {missing}")
    floor = planes[0]
    for i, name in enumerate(soles):
        sole = spec.geom(name)
        body = sole.parent
        for corner, (x, y) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
            half_x, half_y, half_z = sole.size
            offset = np.array([x * half_x, y * half_y, _RADIUS - half_z])
            turned = np.empty(3)
            mujoco.mju_rotVecQuat(turned, offset, sole.quat)
            bit = 1 << (_FIRST_BIT + 4 * i + corner)
            feeler = body.add_geom(
                name=f"{_FEELER}{name}_{corner}",
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                size=[_RADIUS, 0, 0],
                pos=sole.pos + turned,
                mass=0.0,
            )
            plane = spec.worldbody.add_geom(
                name=f"{_PLANE}{name}_{corner}",
                type=mujoco.mjtGeom.mjGEOM_PLANE,
                size=floor.size,
            )
            _copy_surface(sole, feeler, 0, bit)
            _copy_surface(floor, plane, bit, 0)
        sole.contype = sole.conaffinity = 0


def _copy_surface(
    source: mujoco.MjsGeom, target: mujoco.MjsGeom, contype: int, conaffinity: int
) -> None:
    """Contact parameters of another geom, but own collision bits; not drawn by viewers."""
    for key in ("friction", "solref", "solimp", "condim", "solmix", "priority", "margin", "gap"):
        setattr(target, key, getattr(source, key))
    target.contype, target.conaffinity, target.group = contype, conaffinity, 5


def feelers_of(model: mujoco.MjModel, sole: str) -> list[int]:
    """Geoms that touch the floor in a sole's place; none on a flat floor."""
    start = f"{_FEELER}{sole}_"
    return [i for i in range(model.ngeom) if model.geom(i).name.startswith(start)]


class UnevenFloor:
    """Heights h(x, y) of a floor, put under the corners while they are in the air.

    h is bilinear between points 0.1 m apart, whose heights are uniform in a range; the pattern
    repeats after 6.4 m. What is left out: the slope within the 0.1 mm that a corner touches, and
    everything between the corners, which a stiff sole would ride on.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, heights: tuple[float, float], seed: int
    ) -> None:
        self._points: list[list[float]] = (
            quantity_stream(seed, "floor_shape").uniform(*heights, (_POINTS, _POINTS)).tolist()
        )
        names = [model.geom(i).name for i in range(model.ngeom)]
        self._feelers = np.array([i for i, name in enumerate(names) if name.startswith(_FEELER)])
        self._planes = np.array([i for i, name in enumerate(names) if name.startswith(_PLANE)])
        # A geom in its body's frame is not placed afresh in every step, unless told.
        model.geom_sameframe[self._planes] = 0
        self._height = model.geom_pos[:, 2]
        self._position = data.geom_xpos
        self._bottom: Floats = np.array([0.0, 0.0, _RADIUS])

    def at(self, x: float, y: float) -> float:
        """Height of the floor [m]."""
        u, v = x / CELL, y / CELL
        i, j = int(u // 1.0), int(v // 1.0)
        u, v = u - i, v - j
        row, after = self._points[i % _POINTS], self._points[(i + 1) % _POINTS]
        j, k = j % _POINTS, (j + 1) % _POINTS
        low = row[j] + (row[k] - row[j]) * v
        return low + (after[j] + (after[k] - after[j]) * v - low) * u

    def place(self) -> float:
        """Put the floor under every corner; how high the lowest corner is above it [m]."""
        lowest = np.inf
        for (x, y, z), plane in zip(self._points_of_corners(), self._planes, strict=True):
            self._height[plane] = height = self.at(x, y)
            lowest = min(lowest, z - height)
        return lowest

    def follow(self) -> None:
        """Put the floor under those corners that are in the air."""
        points = self._points_of_corners()
        floors = self._height[self._planes].tolist()
        for (x, y, z), plane, floor in zip(points, self._planes, floors, strict=True):
            if z - floor > _CLEARANCE:
                self._height[plane] = self.at(x, y)

    def _points_of_corners(self) -> list[list[float]]:
        """Lowest points of the feelers, (x, y, z) each [m]."""
        points: list[list[float]] = (self._position[self._feelers] - self._bottom).tolist()
        return points
