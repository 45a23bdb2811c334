"""Decorative geoms for the scene: arrows, lines, balls, plates."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from hil.interface import Floats

Colour = tuple[float, float, float, float]


class Shapes:
    """A list of MjvGeom that is filled anew for every picture."""

    def __init__(self, geoms: list[Any]) -> None:
        self._geoms = geoms

    def clear(self) -> None:
        """Begin a new picture."""
        self._geoms.clear()

    def ball(self, centre: Floats, radius: float, colour: Colour) -> None:
        """A sphere [m]."""
        self._add(mujoco.mjtGeom.mjGEOM_SPHERE, [radius] * 3, centre, np.eye(3), colour)

    def plate(self, centre: Floats, half: Sequence[float], yaw: float, colour: Colour) -> None:
        """A box turned about the vertical [rad], of half sizes [m]."""
        c, s = np.cos(yaw), np.sin(yaw)
        axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self._add(mujoco.mjtGeom.mjGEOM_BOX, half, centre, axes, colour)

    def line(self, start: Floats, end: Floats, radius: float, colour: Colour) -> None:
        """A rod between two points [m]."""
        self._connect(mujoco.mjtGeom.mjGEOM_CAPSULE, start, end, radius, colour)

    def arrow(self, start: Floats, end: Floats, radius: float, colour: Colour) -> None:
        """An arrow between two points [m]."""
        self._connect(mujoco.mjtGeom.mjGEOM_ARROW, start, end, radius, colour)

    def _connect(
        self, kind: Any, start: Floats, end: Floats, radius: float, colour: Colour
    ) -> None:
        if float(np.linalg.norm(end - start)) < 1e-4:
            return
        geom = self._add(kind, [radius] * 3, start, np.eye(3), colour)
        mujoco.mjv_connector(geom, kind, radius, start, end)

    def _add(
        self, kind: Any, size: Sequence[float], centre: Floats, axes: Floats, colour: Colour
    ) -> Any:
        geom = mujoco.MjvGeom()
        mujoco.mjv_initGeom(
            geom, int(kind), np.array(size, dtype=float), np.array(centre, dtype=float),
            axes.flatten(), np.array(colour, dtype=np.float32),
        )  # fmt: skip
        self._geoms.append(geom)
        return geom
