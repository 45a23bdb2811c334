"""What is drawn around the robot: forces, centre of mass, support, foothold, water."""

from typing import Any

import numpy as np

from hil.convex_hull import convex_hull
from hil.interface import Floats
from hil.view.shapes import Colour, Shapes
from hil.view.stage import Stage

FORCE: Colour = (0.10, 0.55, 0.95, 0.9)
COM: Colour = (0.95, 0.75, 0.10, 1.0)
SUPPORT: Colour = (0.15, 0.65, 0.30, 0.9)
COP: Colour = (0.85, 0.15, 0.60, 1.0)
FOOTHOLD: Colour = (0.95, 0.45, 0.10, 0.55)
WANTED: Colour = (0.35, 0.35, 0.40, 0.8)
WATER: Colour = (0.20, 0.50, 0.85, 0.25)
FLOOR_GAP = 0.002
"""Marks on the floor lie so far above it [m]."""
BASIN = 1.5
"""Half side of the water that is drawn around the robot [m]."""
FORCE_LENGTH = 1.2
"""Length of an arrow of the whole weight, in heights of the root body."""
SPEED_LENGTH = 1.0
"""Length of the wanted speed's arrow [s]."""


class Overlay:
    """Draws one recorded tick, in sizes that follow the robot's."""

    def __init__(self, stage: Stage, geoms: list[Any]) -> None:
        self._stage, self._shapes = stage, Shapes(geoms)
        self._unit = stage.height

    def draw(self, data: Any, row: Any, motion: Any) -> None:
        """`data` placed as `motion`, the estimate or the truth of the tick `row`."""
        self._shapes.clear()
        corners = self._stage.corners(data)
        self._forces(corners, motion["foot_force"])
        self._centre_of_mass(motion["com"])
        self._support(corners, motion["foot_force"])
        if row["status"]["walking"]:
            self._foothold(row["status"], motion["com"])
        self._wanted(motion, row["reference"])
        self._water(motion["base_position"], float(row["reference"]["water_level"]))

    def _forces(self, corners: Floats, forces: Floats) -> None:
        length = FORCE_LENGTH * self._unit / self._stage.weight
        for point, force in zip(corners.reshape(8, 3), forces.reshape(8).tolist(), strict=True):
            if force > 0.0:
                end = point + np.array([0.0, 0.0, force * length])
                self._shapes.arrow(point, end, 0.02 * self._unit, FORCE)

    def _centre_of_mass(self, com: Floats) -> None:
        floor = np.array([com[0], com[1], FLOOR_GAP])
        self._shapes.ball(com, 0.06 * self._unit, COM)
        self._shapes.line(com, floor, 0.008 * self._unit, COM)
        self._shapes.plate(floor, [0.05 * self._unit, 0.05 * self._unit, 0.001], 0.0, COM)

    def _support(self, corners: Floats, forces: Floats) -> None:
        """The hull of the soles that carry, and the centre of pressure in it."""
        total = float(forces.sum())
        carrying = [corners[foot] for foot in (0, 1) if forces[foot].sum() > 0.02 * total]
        if not carrying or total <= 0.02 * self._stage.weight:
            return
        hull = convex_hull(np.concatenate(carrying)[:, :2])
        ring = np.column_stack([hull, np.full(len(hull), FLOOR_GAP)])
        for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            self._shapes.line(start, end, 0.012 * self._unit, SUPPORT)
        cop = (corners * forces[..., None]).sum(axis=(0, 1)) / total
        self._shapes.ball(np.array([cop[0], cop[1], FLOOR_GAP]), 0.04 * self._unit, COP)

    def _foothold(self, status: Any, com: Floats) -> None:
        """Where the pendulum wants the swing foot to land, and what it falls from."""
        target = status["foot_target"]
        swing = 1 - int(status["stance"])
        sole = self._stage.soles[swing]
        place = np.array([target[0], target[1], FLOOR_GAP])
        half = [float(sole.half[0]), float(sole.half[1]), 0.001]
        self._shapes.plate(place, half, float(status["heading"]), FOOTHOLD)
        self._shapes.line(com, place, 0.008 * self._unit, FOOTHOLD)

    def _wanted(self, motion: Any, reference: Any) -> None:
        """The speed that is asked for, along the heading that is asked for."""
        heading = float(reference["heading"])
        speed, lateral = float(reference["speed"]), float(reference["lateral"])
        c, s = np.cos(heading), np.sin(heading)
        base = motion["base_position"]
        start = np.array([base[0], base[1], FLOOR_GAP])
        way = SPEED_LENGTH * np.array([c * speed - s * lateral, s * speed + c * lateral, 0.0])
        self._shapes.arrow(start, start + way, 0.02 * self._unit, WANTED)

    def _water(self, base: Floats, level: float) -> None:
        if level > 0.0:
            centre = np.array([base[0], base[1], level / 2])
            self._shapes.plate(centre, [BASIN, BASIN, level / 2], 0.0, WATER)
