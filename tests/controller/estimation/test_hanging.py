"""A robot that hangs: contacts by its controller's schedule, no odometry, no heading."""

import numpy as np
import pytest

from controller.estimation.hanging import HangingEstimator
from hil.interface import SensorFrame, WalkStatus
from hil.robot_files import load_robot

ROBOT = load_robot("minibiped")
WEIGHT_N = 25.7


@pytest.fixture
def hanging():
    status = WalkStatus()
    return HangingEstimator(ROBOT, 300, status), status


def frame(yaw=0.0, pitch=0.0):
    made = SensorFrame.empty(12)
    made.joint_position[:] = ROBOT.start_position
    made.joint_age_ns[:] = made.imu_age_ns = 0
    made.joint_valid[:] = made.imu_valid = True
    made.imu_orientation[:] = (
        np.cos(yaw / 2) * np.cos(pitch / 2),
        -np.sin(yaw / 2) * np.sin(pitch / 2),
        np.cos(yaw / 2) * np.sin(pitch / 2),
        np.sin(yaw / 2) * np.cos(pitch / 2),
    )
    return made


def test_the_weight_is_on_the_stance_foot_until_phase_one(hanging):
    estimator, status = hanging
    status.walking, status.stance, status.phase = True, 1, 0.99
    estimate = estimator.update(frame())
    np.testing.assert_allclose(estimate.foot_force.sum(axis=1), [0.0, WEIGHT_N], atol=0.1)
    assert estimate.contact.tolist() == [False, True]
    status.phase = 1.01
    estimate = estimator.update(frame())
    np.testing.assert_allclose(estimate.foot_force.sum(axis=1), [WEIGHT_N, 0.0], atol=0.1)
    assert estimate.contact.tolist() == [True, False]


def test_before_it_walks_the_loads_are_the_measured_ones(hanging):
    estimator, _ = hanging
    touched = frame()
    touched.foot_force[0] = 2.0
    for _ in range(100):
        estimate = estimator.update(touched)
    np.testing.assert_allclose(estimate.foot_force, [[2.0] * 4, [0.0] * 4], atol=0.01)


def test_a_rope_turns_the_robot_and_the_estimate_stays_while_tilt_is_seen(hanging):
    estimator, _ = hanging
    for _ in range(300):
        estimate = estimator.update(frame(yaw=1.2, pitch=0.1))
    np.testing.assert_allclose(
        estimate.base_orientation, [np.cos(0.05), 0.0, np.sin(0.05), 0.0], atol=1e-3
    )


def test_it_rests_as_high_as_its_legs_are_long_whatever_touches(hanging):
    estimator, _ = hanging
    straight = frame()
    straight.joint_position[:] = 0.0
    heights = []
    for made in (frame(), straight):
        made.foot_force[0] = 10.0  # a hand, or the floor: the odometry would move with it
        for _ in range(30):
            estimate = estimator.update(made)
        heights.append(float(estimate.base_position[2]))
        np.testing.assert_array_equal(estimate.base_position[:2], 0.0)
        np.testing.assert_array_equal(estimate.base_linear_velocity, 0.0)
    assert 0.2 < heights[0] < heights[1] < 0.3
    assert estimate.com[2] > 0.15
