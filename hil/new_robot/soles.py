"""What each foot stands on: a box under the lowest points of its shapes."""

from dataclasses import dataclass

import numpy as np

from hil.errors import InputError
from hil.interface import Floats
from hil.new_robot.links import Link
from hil.new_robot.posture import PosedLeg, Posture
from hil.new_robot.shapes import low_points

BAND = 0.15
"""Points within this share of the ankle's height above the lowest one are on the ground."""
LEAST_LENGTH, LEAST_WIDTH = 0.2, 0.06
"""Of a sole that can balance a robot, as shares of the leg."""
ASSUMED = (0.545, 0.327, 0.164, 0.045)
"""Length, width, ankle height and how far the middle is ahead of the ankle, of minibiped, as
shares of the leg: taken where a foot has no shape."""
THICKNESS = 0.05
"""Of the box, as a share of the leg."""


@dataclass(frozen=True, slots=True)
class Sole:
    """A level box under a foot in the zero pose, world axes."""

    centre: Floats
    """[m], (3,)"""
    half: Floats
    """Half edges along x, y, z [m], (3,)."""
    assumed: bool
    """The foot has no shape: size and height are minibiped's, scaled."""


def sole_of(file: object, posture: Posture, leg: PosedLeg, foot: Link, side: str) -> Sole:
    """The sole of a foot. Raises InputError for a foot that ends in a point or an edge."""
    points = _points(posture, foot)
    ankle = (leg.anchors["ankle_pitch"] + leg.anchors["ankle_roll"]) / 2
    if points is None:
        return _assumed(leg, ankle)
    ground = float(points[:, 2].min())
    band = BAND * (ankle[2] - ground)
    under = points[points[:, 2] <= ground + band]
    low, high = under.min(axis=0)[:2], under.max(axis=0)[:2]
    length, width = (high - low).tolist()
    if length < LEAST_LENGTH * leg.length or width < LEAST_WIDTH * leg.length:
        raise InputError(
            f"{file}: the {side} foot stands on {1e3 * length:.0f} x {1e3 * width:.0f} mm: the "
            f"walk needs a sole of at least {1e3 * LEAST_LENGTH * leg.length:.0f} x "
            f"{1e3 * LEAST_WIDTH * leg.length:.0f} mm, level in the model's zero pose"
        )
    thick = min(THICKNESS * leg.length, 0.8 * float(ankle[2] - ground))
    centre = np.array([*(low + high) / 2, ground + thick / 2])
    return Sole(centre, np.array([length / 2, width / 2, thick / 2]), False)


def _points(posture: Posture, foot: Link) -> Floats | None:
    """Points of a foot's shapes that can touch, or of those to be seen where none can."""
    model, data = posture.model, posture.data
    geoms = [geom for geom in range(model.ngeom) if model.geom_bodyid[geom] in foot.bodies]
    touching = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
    found = [low_points(model, data, geom) for geom in touching or geoms]
    points = np.concatenate([np.empty((0, 3)), *found])
    return points if points.size else None


def _assumed(leg: PosedLeg, ankle: Floats) -> Sole:
    length, width, height, ahead = (share * leg.length for share in ASSUMED)
    thick = THICKNESS * leg.length
    centre = ankle + np.array([ahead, 0.0, thick / 2 - height])
    return Sole(centre, np.array([length, width, thick]) / 2, True)
