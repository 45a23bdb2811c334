"""The body of a ball: real, with mass, that waits far away until it is thrown."""

import mujoco
import numpy as np

BALL = "thrown_ball"
DENSITY = 600.0
"""Of a medicine ball [kg/m³]: 5 kg have a radius of 0.126 m."""
COLLISION_BIT = 1 << 30
"""Of contype and conaffinity; robots use the low ones."""
_WAITING_PLACE = (0.0, 0.0, 100.0)


def ball_radius(mass: float) -> float:
    """Radius [m] of a ball of a mass [kg]."""
    return float(np.cbrt(3.0 * mass / (4.0 * np.pi * DENSITY)))


def add_ball(spec: mujoco.MjSpec) -> None:
    """Add the waiting ball to a robot's MJCF; weightless until it is thrown."""
    body = spec.worldbody.add_body(name=BALL, pos=_WAITING_PLACE, gravcomp=1.0)
    body.add_freejoint(name=BALL)
    body.add_geom(
        name=BALL,
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[ball_radius(1.0), 0.0, 0.0],
        mass=1.0,
        contype=COLLISION_BIT,
        conaffinity=0,
    )
