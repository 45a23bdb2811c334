"""Gravity compensation of everything but the stance leg.

Seed 000_bd1305a0ae731442, section 3: torques that compensate the weight of the limbs.
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from hil.interface import Floats


class GravityCompensation:
    """τ_j = −(c_j − p_j) × m_j·g on the child of every joint j outside the stance leg.

    c_j and m_j are the centre and mass of everything beyond joint j, p_j is its centre.
    """

    def __init__(self, robot: RobotModel, groups: JointGroups) -> None:
        self._robot = robot
        self._groups = groups
        self._weight = robot.model.body_subtreemass[groups.child] * robot.gravity
        beyond = groups.descends()
        stance_legs = [beyond[:, hip] for hip in groups.legs("hip")]
        self._masks = [np.where(leg, 0.0, self._weight) for leg in stance_legs]

    def torques(self, stance: int) -> Floats:
        """World torque vectors [N·m], shape (groups, 3); zero on the stance leg."""
        groups = self._groups
        lever = self._robot.data.subtree_com[groups.child] - groups.anchors()
        weight = self._masks[stance]
        result: Floats = np.zeros((len(groups), 3))
        result[:, 0] = weight * lever[:, 1]
        result[:, 1] = -weight * lever[:, 0]
        return result
