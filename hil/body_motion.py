"""How a robot's body moved and what its feet pressed on: what a twin is carried by."""

from dataclasses import dataclass, fields

import numpy as np

from hil.interface import Floats, Ints

CORNERS = np.array([(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)])
"""Signs of x and y of front left, front right, rear left, rear right."""


@dataclass(frozen=True, slots=True)
class BodyMotion:
    """Smoothed motion of the root body and loads of the feet over T ticks."""

    position: Floats
    """[m], (T, 3)."""
    velocity: Floats
    acceleration: Floats
    orientation: Floats
    """Base to world, (T, 4)."""
    spin: Floats
    """Angular velocity in base axes [rad/s], (T, 3)."""
    spin_rate: Floats
    """Its derivative [rad/s²], (T, 3)."""
    corners: Floats
    """Measured corner forces, none of them negative [N], (T, 2, 4)."""
    shear: Floats
    """Horizontal force on each foot in world axes [N], (T, 2, 2)."""

    def at(self, ticks: Ints) -> "BodyMotion":
        """Some of the ticks."""
        return BodyMotion(*(getattr(self, item.name)[ticks] for item in fields(self)))


def foot_load(
    corners: Floats, shear: Floats, axes: Floats, centre: Floats, half: Floats
) -> tuple[Floats, Floats]:
    """Force on one sole and the point where it acts, world axes [N], [m], (3,) each.

    Corner forces (4,) along the sole's normal, a horizontal force (2,) with them, both in the
    middle of the pressure; `axes` (3, 3) and `centre` (3,) of the sole's box, its half size (3,).
    """
    total = float(corners.sum())
    if total <= 0.0:
        return np.zeros(3), centre
    middle = corners @ CORNERS / total * half[:2]
    force = total * axes[:, 2]
    force[:2] += shear
    return force, centre + axes @ (middle[0], middle[1], -half[2])
