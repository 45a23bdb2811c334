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
        self._centres: Floats = robot.data.subtree_com
        self._anchors: Floats = robot.data.xanchor
        self._children, self._joints = groups.child, groups.anchor_joint
        self._result: Floats = np.zeros((len(groups), 3))
        weight = robot.model.body_subtreemass[groups.child] * robot.gravity
        beyond = groups.descends()
        stance_legs = [beyond[:, hip] for hip in groups.legs("hip")]
        self._masks = [np.where(leg, 0.0, weight) for leg in stance_legs]

    def torques(self, stance: int) -> Floats:
        """World torque vectors [N·m], shape (groups, 3); zero on the stance leg; the array
        is reused."""
        lever = self._centres.take(self._children, axis=0)
        lever -= self._anchors.take(self._joints, axis=0)
        weight = self._masks[stance]
        result = self._result
        np.multiply(weight, lever[:, 1], out=result[:, 0])
        np.multiply(-weight, lever[:, 0], out=result[:, 1])
        return result
