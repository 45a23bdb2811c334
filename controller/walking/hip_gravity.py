"""Stance-hip gravity term: the stance hip carries the weights that turn the pelvis about it.

Ours. The order of seed 000_bd1305a0ae731442 adds gravity compensation after the root balance, so
that no hip bears the weight of pelvis, trunk and swing leg and the pelvis droops.
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from hil.interface import Floats


class HipGravity:
    """Torque vector on the child of the stance hip [N·m], horizontal.

    The hip must bear, on the pelvis, +Σ(c_i − p) × m_i·g·ẑ over the weights m_i·g of pelvis,
    trunk and swing leg, p being the stance hip; the thigh gets the reaction. The body above the
    stance hip is the whole body without the stance leg, whose swing foot the ground already
    carries with F_swing: (c_above − p) × m_above·g − (p_ankle − p) × F_swing, times λ.
    """

    def __init__(self, robot: RobotModel, groups: JointGroups) -> None:
        self._robot = robot
        self._legs = groups.child[groups.legs("hip")]
        self._hip_joints = groups.anchor_joint[groups.legs("hip")]
        self._leg_mass: list[float] = robot.model.body_subtreemass[self._legs].tolist()

    def torque(self, stance: int, share: float, swing_load: float) -> Floats:
        """On the stance thigh, world axes, shape (3,).

        `share` is λ, the part of the hips' moment that the stance hip bears, `swing_load` the
        vertical force on the other foot [N].
        """
        robot, swing = self._robot, 1 - stance
        data, gravity = robot.data, robot.gravity
        hip = data.xanchor[self._hip_joints[stance]]
        leg = self._leg_mass[stance]
        moment = robot.mass * (robot.com - hip)
        moment -= leg * (data.subtree_com[self._legs[stance]] - hip)
        moment *= gravity
        moment -= swing_load * (robot.ankles[swing] - hip)
        # r × (0, 0, −W) = (−r_y·W, r_x·W, 0) acts on the pelvis; the thigh takes it up.
        return share * np.array((-moment[1], moment[0], 0.0))
