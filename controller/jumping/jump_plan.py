"""The whole jump, planned before the push: crouch, take-off, flight, and where the feet land."""

import math
from dataclasses import dataclass

import numpy as np

from controller.jumping.path import JumpPath, JumpTarget, estimate_path
from hil.interface import Floats

ROUNDS = 30
"""Rounds of the fixed point; each one shrinks its error to about a fifth."""
LIFT = 0.8
"""Mean acceleration upwards while a landing is absorbed, in g."""


@dataclass(frozen=True, slots=True)
class Heights:
    """How high the centre of mass is above the soles [m]."""

    standing: float
    take_off: float
    touch_down: float
    resting: float
    """Where a landing ends, before the body rises."""


@dataclass(frozen=True, slots=True)
class JumpPlan:
    """Where the centre of mass and the feet shall be."""

    path: JumpPath
    """From the begin of the push."""
    crouch: Floats
    """Centre of mass at the begin of the push [m], (3,)."""
    feet: Floats
    """Centre of the soles at the start [m], (3,)."""
    landing_feet: Floats
    """Centre of the soles at touch-down [m], (3,)."""


def plan_jump(
    target: JumpTarget,
    mass: float,
    heights: Heights,
    feet: Floats,
    velocity: Floats,
    pressure: Floats,
) -> JumpPlan:
    """The plan of a jump from feet whose soles' centre is at `feet` (3,) [m].

    The centre of mass must fly as far as the feet go, less what it is ahead of them at take-off,
    plus what it is at touch-down (horizontal, from the soles' centre):

        v·T = d + o_land − o_push,   o_land = p − v/ω,   o_push = x + (v₀ + v)·t/2

    o_land is where a pendulum of that height comes to rest over p (its capture point), while the
    fall is absorbed at LIFT·g on average: ω² = (1 + LIFT)·g/h.
    x, the crouch, is chosen so that the centre of pressure of the push lies over p on average,

        x = p + a·h/(g + a_z) − v₀·t/2 − a·t²/6,   a = (v − v₀)/t,

    since a force through the centre of mass meets the ground a·h/(g + a_z) behind it. Push time t
    and v_z are those of `estimate_path` (seed 004_2880d7939e94ed85, section 3.1). `velocity` of
    the centre of mass when the push begins, horizontal (2,) [m/s]; `pressure` p (2,) [m].
    """
    displacement = np.array(target.displacement)
    g = target.gravity
    omega = math.sqrt((1.0 + LIFT) * g / heights.touch_down)
    shift_z = heights.touch_down - heights.take_off
    still = (float(velocity[0]), float(velocity[1]), 0.0)
    shift = np.zeros(2)
    crouch = np.zeros(2)
    for _ in range(ROUNDS):
        path = estimate_path(
            target, mass, initial_velocity=still, posture_shift=(shift[0], shift[1], shift_z)
        )
        push, lift = path.push_time, path.acceleration[2]
        speed = path.take_off_velocity[:2]
        acceleration = (speed - velocity) / push
        height = heights.take_off - target.push_depth / 2.0
        crouch = pressure + acceleration * (height / (g + lift) - push**2 / 6.0)
        crouch -= velocity * push / 2.0
        at_push_end = crouch + (velocity + speed) * push / 2.0
        shift = (pressure - speed / omega - at_push_end + shift) / 2.0
    start = np.append(crouch, heights.take_off - target.push_depth) + feet
    path = estimate_path(
        target,
        mass,
        start=tuple(start),
        initial_velocity=still,
        posture_shift=(shift[0], shift[1], shift_z),
    )
    return JumpPlan(path, start, feet, feet + displacement)
