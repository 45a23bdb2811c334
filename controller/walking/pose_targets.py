"""Target orientations of all joints: key poses, the swing leg's inverse kinematics, the start pose.

Joints without a curve of their own hold the pose of the robot description's `start`, or, when
they are tracked in the heading frame, stay upright.
"""

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.walking.gait import Gait
from controller.walking.gait_styles import GaitStyles
from controller.walking.hand_poses import HandPoses
from controller.walking.joint_groups import JointGroups
from controller.walking.pose_tracking import PoseTracking
from controller.walking.rotations import turn_about_y, turn_about_z, yaw_pitch_roll
from controller.walking.swing_leg import SwingLeg
from controller.walking.torque_config import TorqueWalkingConfig
from hil.description import RobotDescription
from hil.interface import Floats


class PoseTargets:
    """Fills the targets of a `PoseTracking`, phase by phase.

    Curves describe a step on the left foot; yaw and roll change sign on the right one.
    """

    def __init__(
        self,
        description: RobotDescription,
        config: TorqueWalkingConfig,
        robot: RobotModel,
        groups: JointGroups,
        tracking: PoseTracking,
        styles: GaitStyles,
    ) -> None:
        self._tracking = tracking
        self._styles = styles
        self._back = groups.index("back")
        self._hips, self._knees = groups.legs("hip"), groups.legs("knee")
        self._ankles = groups.legs("ankle")
        self._hands = (
            HandPoses(config.hands, robot, groups, styles.standard, config.gait.max_phase)
            if config.hands is not None
            else None
        )
        held = _start_pose(description, robot, groups)
        relative = tracking.relative[: len(groups)]
        tracking.target[: len(groups)][relative] = held[relative]
        tracking.target[[*self._knees, *self._ankles]] = np.eye(3)  # they only turn about y

    def update(self, gait: Gait) -> float:
        """Set the targets of a phase; returns the drop of the swing ankle below its hip [m]."""
        tracking, sign = self._tracking, gait.stance_sign
        angles = self._styles.curves.at(gait.phase)
        root, yaw, pitch, roll, knee, stance_foot, swing_foot, drop = angles
        target, stance, swing = tracking.target, gait.stance, gait.swing
        turn_about_y(target[tracking.root], root)
        target[self._back] = yaw_pitch_roll(sign * yaw, pitch, sign * roll)
        turn_about_y(target[self._knees[stance]], knee)
        turn_about_y(target[self._ankles[stance]], stance_foot)
        turn_about_y(target[self._ankles[swing]], swing_foot)
        tracking.target_rate[self._hips[gait.stance]] = 0.0
        tracking.target_rate[self._knees[gait.stance]] = 0.0
        if self._hands is not None:
            self._pose_arms(self._hands, gait)
        return drop

    def _pose_arms(self, hands: HandPoses, gait: Gait) -> None:
        """Keep the hands where they belong."""
        target = self._tracking.target
        for (shoulder, elbow), pose in zip(
            hands.groups, hands.at(gait.stance, gait.phase), strict=True
        ):
            target[shoulder] = pose[:9].reshape(3, 3)
            turn_about_z(target[elbow], float(pose[9]))

    def set_swing_leg(self, swing: int, leg: SwingLeg) -> None:
        """Take over the inverse kinematics of the swing hip and knee."""
        tracking = self._tracking
        tracking.target[self._hips[swing]] = leg.hip
        tracking.target_rate[self._hips[swing]] = leg.hip_rate
        turn_about_y(tracking.target[self._knees[swing]], leg.knee)
        tracking.target_rate[self._knees[swing], 1] = leg.knee_rate


def _start_pose(description: RobotDescription, robot: RobotModel, groups: JointGroups) -> Floats:
    """Orientation of every group's child in its parent, in the start pose."""
    data = mujoco.MjData(robot.model)
    data.qpos[robot.qpos_addresses] = description.start_position
    mujoco.mj_kinematics(robot.model, data)
    child = data.xmat[groups.child].reshape(-1, 3, 3)
    parent = data.xmat[groups.parent].reshape(-1, 3, 3)
    pose: Floats = np.swapaxes(parent, 1, 2) @ child
    return pose
