"""Buoyancy in the external force-field compensation: what the liquid carries, no joint need.

Seed 003_73fecd8ec8927aad, section 5.3: virtual forces oppose weight and buoyancy of every body
part, F = −mg + ρV_i (times g, which the print leaves out). Drag is not compensated: it would take
many small forces.
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from hil.interface import Floats
from hil.submerged import SubmergedParts

CELLS_A_LEG = 24
"""Cells of volume along a leg."""


class BuoyancyCompensation:
    """τ_j = Σ (c_i − p_j) × ρV_i·g over the parts i beyond every joint j outside the stance leg.

    The negative of the lift's moment about the joint, on its child: what gravity compensation
    asks for too much. V_i and its centroid c_i are those of the part under the level that the
    robot is told to expect; p_j is the joint's centre.
    """

    def __init__(self, robot: RobotModel, groups: JointGroups) -> None:
        """Raises InputError for a robot of other shapes than boxes, capsules and spheres."""
        self._gravity = robot.gravity
        cell = robot.leg_length / CELLS_A_LEG
        self._parts = SubmergedParts(robot.model, robot.data, robot.root_body, cell)
        self._anchors: Floats = robot.data.xanchor
        self._joints = groups.anchor_joint
        beyond = groups.moves(self._parts.bodies).T.astype(float)
        legs = [groups.descends()[:, hip] for hip in groups.legs("hip")]
        self._masks = [np.where(leg[:, None], 0.0, beyond) for leg in legs]

    def torques(self, stance: int, level: float, density: float) -> Floats:
        """World torque vectors [N·m], shape (groups, 3); zero on the stance leg.

        `level` is that of the liquid above the floor [m], `density` its own [kg/m³].
        """
        parts = self._parts
        parts.update(level)
        lift = density * self._gravity * parts.volumes
        mask = self._masks[stance]
        moment = mask @ (lift[:, None] * parts.centres[:, :2])
        moment -= (mask @ lift)[:, None] * self._anchors[self._joints, :2]
        result = np.zeros((len(self._joints), 3))
        result[:, 0], result[:, 1] = -moment[:, 1], moment[:, 0]
        return result
