"""Inverse kinematics of the swing leg against the model's forward kinematics."""

import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.rotations import about_y, about_z
from controller.walking.swing_leg import LegLinks, SwingLeg, two_link
from controller.walking.torque_config import SwingLegConfig

from .conftest import body_state

HIP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def links(human):
    robot = RobotModel(human)
    return LegLinks(robot.thigh_length, robot.shank_length, robot.knee_offset)


@pytest.mark.parametrize("target", [(0.2, 0.0, 0.15), (-0.25, 0.03, 0.12), (0.0, -0.05, 0.3)])
def test_ankle_arrives_where_it_was_sent(human, links, target):
    """Hip angles from the solution's orientation: yaw, roll, pitch are Z·X·Y on the thigh."""
    robot = RobotModel(human)
    names = human.joint_names
    state = body_state(human)
    robot.set_state(state)
    ankle = robot.hip_positions[0] + np.array(target) - HIP
    thigh, knee = two_link(links, robot.hip_positions[0], ankle, np.array([0.0, 1, 0]), 0.993)
    angles = {
        "left_hip_yaw": np.arctan2(-thigh[0, 1], thigh[1, 1]),
        "left_hip_roll": np.arcsin(thigh[2, 1]),
        "left_hip_pitch": np.arctan2(-thigh[2, 0], thigh[2, 2]),
        "left_knee": knee,
    }
    for name, angle in angles.items():
        state.joint_position[names.index(name)] = angle
    robot.set_state(state)
    assert robot.ankle_positions[0] == pytest.approx(ankle, abs=1e-3)
    assert knee > 0


def test_target_out_of_reach_is_approached_in_its_direction(links):
    ankle = HIP + 3.0 * np.array([0.6, 0.0, -0.8])
    thigh, knee = two_link(links, HIP, ankle, np.array([0.0, 1.0, 0.0]), reach=0.993)
    shank = about_y(knee - links.knee_offset)
    reached = -links.thigh * thigh[:, 2] - links.shank * (thigh @ shank)[:, 2]
    assert np.linalg.norm(reached) == pytest.approx(0.993 * (links.thigh + links.shank))
    assert reached / np.linalg.norm(reached) == pytest.approx([0.6, 0.0, -0.8])


def test_target_velocities_are_differences_within_the_limit(links):
    leg = SwingLeg(SwingLegConfig(reach=0.993, rate_limit=5.0), links, dt=0.01)
    pelvis, lateral = np.eye(3), np.array([0.0, 1.0, 0.0])
    leg.update(HIP, np.array([0.1, 0.0, 0.2]), lateral, pelvis)
    first = leg.knee
    assert leg.knee_rate == 0.0
    leg.update(HIP, np.array([0.1, 0.0, 0.21]), lateral, pelvis)
    assert leg.knee_rate == pytest.approx((leg.knee - first) / 0.01)
    assert 0 < leg.knee_rate < 5.0
    leg.update(HIP, np.array([0.5, 0.0, 0.6]), lateral, pelvis)
    assert leg.knee_rate == 5.0
    leg.begin_step()
    leg.update(HIP, np.array([-0.1, 0.0, 0.1]), lateral, pelvis)
    assert leg.knee_rate == 0.0
    assert leg.hip_rate == (0.0, 0.0, 0.0)


def test_turned_pelvis_does_not_move_the_thigh(links):
    ankle, lateral = np.array([0.15, 0.02, 0.2]), np.array([0.0, 1.0, 0.0])
    leg = SwingLeg(SwingLegConfig(reach=0.993, rate_limit=5.0), links, dt=0.01)
    pelvis = about_z(0.4) @ about_y(0.1)
    leg.update(HIP, ankle, lateral, pelvis)
    thigh, _ = two_link(links, HIP, ankle, lateral, 0.993)
    assert pelvis @ leg.hip == pytest.approx(thigh)
