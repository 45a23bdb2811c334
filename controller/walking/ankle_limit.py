"""Ankle torque limit: the stance foot stays flat because its centre of pressure stays inside.

Ours; the seed's stored code guards the ankle by rules on contact and rate instead. A foot under
the load F tips over an edge at lever b as soon as the ankle torque exceeds b·F.
"""

from dataclasses import dataclass

import mujoco

from controller.robot_model import RobotModel
from hil.description import Foot


@dataclass(frozen=True, slots=True)
class SoleLevers:
    """Distances from the ankle to the edges that carry load [m]."""

    front: float
    """To the rear edge of the toes, or to the front of the sole of a foot without toes."""
    rear: float
    half_width: float


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
    return SoleLevers(front, float(sole.size[0] - place[0]), float(sole.size[1]))


def limited(
    levers: SoleLevers, fraction: float, load: float, pitch: float, roll: float
) -> tuple[float, float]:
    """Pitch and roll torques on the foot [N·m] within what the load F [N] keeps flat.

    −κ·rear·F ≤ τ_pitch ≤ κ·front·F and |τ_roll| ≤ κ·half_width·F; pitch positive toe down.
    """
    force = fraction * load
    side = levers.half_width * force
    return (
        min(max(pitch, -levers.rear * force), levers.front * force),
        min(max(roll, -side), side),
    )
