"""Arm poses that keep the hands at their place, checked with MuJoCo's kinematics."""

import mujoco
import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.hand_poses import HandPoses
from controller.walking.joint_groups import JointGroups
from controller.walking.key_poses import CurveTable
from controller.walking.rotations import about_y

from .conftest import HumanWalk

TARGET = np.array([0.19, 0.16, 0.365])
"""Of the left hand from the pelvis [m]."""


@pytest.fixture(scope="module")
def poses(human, human_config):
    robot = RobotModel(human)
    groups = JointGroups(human, robot)
    curves = CurveTable(human_config.key_poses.curves(), 1.05)
    return HandPoses(human_config.hands, robot, groups, curves, 1.05), curves


def hinge_angles(rotation):
    """Roll, yaw and pitch of R_x·R_z·R_y, the shoulder's hinges."""
    return (
        np.arctan2(rotation[2, 1], rotation[1, 1]),
        -np.arcsin(rotation[0, 1]),
        np.arctan2(rotation[0, 2], rotation[0, 0]),
    )


@pytest.mark.parametrize("stance", [0, 1])
@pytest.mark.parametrize("phase", [0.0, 0.3, 0.505, 0.9])
def test_hands_are_at_their_place_from_the_pelvis_in_every_key_pose(human, poses, stance, phase):
    hands, curves = poses
    model = RobotModel(human).model
    data = mujoco.MjData(model)
    root, yaw, pitch, roll = curves.at(phase)[:4]
    sign = 1 - 2 * stance
    # The torso's target is world upright turned by the back's curves, the pelvis pitched by root's.
    world = np.zeros(9)
    quaternion = np.zeros(4)
    mujoco.mju_euler2Quat(quaternion, np.array([sign * yaw, pitch, sign * roll]), "zyx")
    mujoco.mju_quat2Mat(world, quaternion)
    relative = about_y(root).T @ world.reshape(3, 3)
    back = (np.arctan2(relative[1, 0], relative[0, 0]), 0.0, 0.0)
    angles = {"back_yaw": np.arctan2(-relative[0, 1], relative[1, 1]),
              "back_roll": np.arcsin(relative[2, 1]),
              "back_pitch": np.arctan2(-relative[2, 0], relative[2, 2])}  # fmt: skip
    assert abs(back[0]) < 0.2
    for side, row in zip(("left", "right"), hands.at(stance, phase), strict=True):
        a, b, c = hinge_angles(row[:9].reshape(3, 3))
        angles |= {f"{side}_shoulder_roll": a, f"{side}_shoulder_yaw": b}
        angles |= {f"{side}_shoulder_pitch": c, f"{side}_elbow": row[9]}
    for name, angle in angles.items():
        joint = model.joint(name)
        assert joint.range[0] < angle < joint.range[1]
        data.qpos[joint.qposadr] = angle
    mujoco.mj_kinematics(model, data)
    pelvis = data.body("pelvis").xpos
    for side, mirror in (("left", 1.0), ("right", -1.0)):
        arm = data.body(f"{side}_forearm")
        hand = arm.xpos + arm.xmat.reshape(3, 3) @ (0.0, 0.15 * mirror, 0.0)
        assert hand - pelvis == pytest.approx(TARGET * (1.0, mirror, 1.0), abs=2e-3)


def furthest_hand(overrides=()):
    """Largest distance of a hand from its place in one second of walking, on any axis [m]."""
    human = HumanWalk(overrides=overrides).walk(3.0)
    model = RobotModel(human.description)
    worst = 0.0
    for _ in range(300):
        model.set_state(human.tick())
        pelvis = model.data.body("pelvis")
        for side, mirror in (("left", 1.0), ("right", -1.0)):
            arm = model.data.body(f"{side}_forearm")
            hand = arm.xpos + arm.xmat.reshape(3, 3) @ (0.0, 0.15 * mirror, 0.0)
            place = pelvis.xmat.reshape(3, 3).T @ (hand - pelvis.xpos)
            worst = max(worst, np.abs(place - TARGET * (1.0, mirror, 1.0)).max())
    return worst


def test_walking_hands_stay_near_their_place():
    assert furthest_hand() < 0.08


def test_hands_are_elsewhere_without_their_key_poses():
    assert furthest_hand(("walking.hands=null",)) > 0.2
