"""Walking in the air: the body that is imagined, and steps on schedule."""

import math

import numpy as np
import pytest

from controller.estimation.hanging import HangingEstimator
from controller.robot_model import RobotModel
from controller.walking.imagined_pendulum import ImaginedPendulum
from controller.walking.servo_walker import ServoWalker
from hil.interface import Reference, SensorFrame
from hil.robot_files import load_robot

ROBOT = load_robot("minibiped")
PERIOD = 0.32
SPEED, SWAY = (0.2, 0.03), -0.1


@pytest.fixture(scope="module")
def pendulum():
    model = RobotModel(ROBOT)
    model.data.subtree_com[model.root_body][2] = 0.25
    return ImaginedPendulum(model, PERIOD, 0.0)


def state(pendulum, phase):
    pendulum.imagine(phase, SPEED, SWAY, 0.01)
    return np.array([pendulum.place, pendulum.velocity])


def test_the_imagined_body_obeys_the_pendulum(pendulum):
    omega, dphi = math.sqrt(9.81 / 0.25), 1e-4
    for phase in (0.1, 0.4, 0.8):
        before, now, after = (state(pendulum, phase + d) for d in (-dphi, 0.0, dphi))
        rate = (after - before) / (2 * dphi * PERIOD)
        np.testing.assert_allclose(rate[0], now[1], rtol=1e-5, atol=1e-7)
        np.testing.assert_allclose(rate[1], omega**2 * now[0], rtol=1e-5, atol=1e-7)


def test_a_step_ends_where_the_next_one_begins(pendulum):
    begin, end = state(pendulum, 0.0), state(pendulum, 1.0)
    moved = end[0] - begin[0]
    np.testing.assert_allclose(moved, np.multiply(SPEED, PERIOD))
    # the next stance foot is a sway to the swing side and as far ahead as the body went
    next_foot = np.array([SPEED[0], SPEED[1]]) * PERIOD + (0.0, SWAY)
    pendulum.imagine(0.0, SPEED, -SWAY, 0.01)
    np.testing.assert_allclose(end[0] - next_foot, pendulum.place, atol=1e-12)
    np.testing.assert_allclose(end[1], pendulum.velocity, atol=1e-12)


def test_the_ankle_is_behind_the_pivot(pendulum):
    pendulum.imagine(0.5, SPEED, SWAY, 0.01)
    np.testing.assert_allclose(np.subtract(pendulum.seen, pendulum.place), (0.01, 0.0), atol=1e-12)


def test_steps_follow_the_clock_and_joints_that_obey_stay_in_range():
    rate, seconds = 200, 4.0
    walker = ServoWalker(ROBOT, rate, hoisted=True)
    estimator = HangingEstimator(ROBOT, rate, walker.status)
    frame = SensorFrame.empty(12)
    frame.joint_position[:] = ROBOT.start_position
    frame.joint_age_ns[:] = frame.imu_age_ns = 0
    frame.joint_valid[:] = frame.imu_valid = True
    low, high = np.array([joint.range for joint in ROBOT.joints]).T
    began, loads = [], []
    for tick in range(round(seconds * rate)):
        frame.time_ns = round(tick * 1e9 / rate)
        steps = walker.status.steps
        command = walker.step(estimator.update(frame), Reference(speed=0.15))
        frame.joint_position[:] = command.position  # servos without a fault
        if walker.status.steps != steps:
            began.append(tick / rate)
        stance = slice(0, 6) if walker.status.stance == 0 else slice(6, 12)
        loads.append(np.abs(command.torque[stance]).max())
        assert ((low <= command.position) & (command.position <= high)).all()
    # the period, and the ticks in which a landing is seen
    np.testing.assert_allclose(np.diff(began), PERIOD, atol=3.5 / rate)
    assert len(began) >= seconds / PERIOD - 2
    assert max(loads) < 0.5  # the weight of one leg; on the ground a stance hip bears 1.4 N·m
