"""Ankle torque limit: the stance foot stays flat because its centre of pressure stays inside.

Ours; the seed's stored code guards the ankle by rules on contact and rate instead. A foot under
the load F tips over an edge at lever b as soon as the ankle torque exceeds b·F, less what the
ground's horizontal force, at its lever under the ankle, adds: after a push that force alone would
roll a foot over its outer edge.
"""

import math
from dataclasses import dataclass

import mujoco

from controller.robot_model import RobotModel
from controller.walking.heading_frame import Pair
from hil.description import Foot
from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class SoleLevers:
    """Distances from the ankle to the edges that carry load [m]."""

    front: float
    """To the rear edge of the toes, or to the front of the sole of a foot without toes."""
    rear: float
    half_width: float
    height: float
    """Of the ankle above the sole."""


def sole_levers(robot: RobotModel, foot: Foot) -> SoleLevers:
    """Levers of a foot from its geometry, with all joints at zero."""
    model = robot.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ankle = data.xanchor[model.joint(foot.ankle).id]
    sole = model.geom(foot.sole)
    place = data.geom_xpos[sole.id] - ankle
    front = float(place[0] + sole.size[0])
    if foot.toe is not None:
        toe = model.geom(foot.toe)
        front = float(data.geom_xpos[toe.id][0] - ankle[0] - toe.size[0])
    height = float(sole.size[2] - place[2])
    return SoleLevers(front, float(sole.size[0] - place[0]), float(sole.size[1]), height)


def ground_slope(levers: SoleLevers, com: Floats, ankle: Floats, foot: Floats) -> Pair:
    """Horizontal per vertical ground force, (F_x/F, F_y/F) in the foot's heading.

    The force on the one stance foot points at the centre of mass, as in the inverted pendulum
    model. `com` and `ankle` are world points [m], shape (3,), `foot` is the foot's rotation
    matrix, shape (3, 3).
    """
    forward, left, up = (com - ankle).tolist()
    cos, sin = float(foot[0, 0]), float(foot[1, 0])
    height = math.hypot(cos, sin) * (up + levers.height)
    return (cos * forward + sin * left) / height, (cos * left - sin * forward) / height


def limited(
    levers: SoleLevers, fraction: float, load: float, slope: Pair, pitch: float, roll: float
) -> Pair:
    """Pitch and roll torques on the foot [N·m] within what the load F [N] keeps flat.

    The centre of pressure is at p_x = (τ_pitch − h·F_x)/F and p_y = −(τ_roll + h·F_y)/F from the
    ankle, h being its height; −κ·rear ≤ p_x ≤ κ·front and |p_y| ≤ κ·half_width. Pitch is positive
    toe down; `slope` is (F_x/F, F_y/F).
    """
    force = fraction * load
    side = levers.half_width * force
    ahead, aside = (levers.height * load * part for part in slope)
    return (
        min(max(pitch, ahead - levers.rear * force), ahead + levers.front * force),
        min(max(roll, -aside - side), side - aside),
    )
