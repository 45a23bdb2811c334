"""How the body moved in a recording, and what its feet pressed on."""

import numpy as np

from hil.after.smoothing import parabolas, smooth
from hil.body_motion import BodyMotion
from hil.interface import GRAVITY, Floats
from hil.recording import Rows

HANGING_SHARE = 0.1
"""Of the weight on the feet: with less, nothing presses them on a floor that could push back; a
robot that has less on the mean hangs."""


def measured_motion(rows: Rows, rate_hz: int, mass: float) -> BodyMotion:
    """The motion that the estimator saw, without the lag of a filter.

    Load cells measure what presses, not what rubs. The horizontal force is taken from the
    movement of the centre of mass, m·ẍ, and belongs to the feet as the load does. A robot whose
    feet carry nothing hangs: there is no odometry then, and its body is taken to rest in one place.
    """
    estimate, frame = rows["estimate"], rows["frame"]
    least = HANGING_SHARE * mass * GRAVITY
    carried = frame["foot_force"].sum(axis=(1, 2)).mean() > least
    places = estimate["base_position"]
    if not carried:
        places = np.broadcast_to(places[0], places.shape)
    position, velocity, acceleration = parabolas(places, rate_hz)
    orientation = smooth(continuous(estimate["base_orientation"]), rate_hz)
    orientation /= np.linalg.norm(orientation, axis=1, keepdims=True)
    spin, spin_rate, _ = parabolas(estimate["base_angular_velocity"], rate_hz)
    corners = np.maximum(smooth(frame["foot_force"], rate_hz), 0.0)
    loads = corners.sum(axis=2)
    total = loads.sum(axis=1, keepdims=True)
    share = np.divide(loads, total, out=np.zeros_like(loads), where=total > least)
    _, pushed, _ = parabolas(estimate["com_velocity"], rate_hz)
    shear = share[:, :, None] * (mass * pushed[:, None, :2])
    return BodyMotion(
        position, velocity, acceleration, orientation, spin, spin_rate, corners, shear
    )


def continuous(quaternions: Floats) -> Floats:
    """The same orientations without jumps of sign, (T, 4)."""
    turned = np.einsum("ti,ti->t", quaternions[1:], quaternions[:-1]) < 0
    signs = np.concatenate(([1.0], np.where(turned, -1.0, 1.0)))
    return np.asarray(quaternions * np.cumprod(signs)[:, None])
