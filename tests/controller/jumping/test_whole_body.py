"""Whole-body torques: a body in the air falls, one on its feet weighs what it weighs."""

import numpy as np
import pytest

from controller.estimation.sensors import empty_estimate
from controller.jumping.body_tasks import BodyTasks
from controller.jumping.posture import standing
from controller.jumping.whole_body import WholeBody
from hil.robot_files import load_robot

G = 9.81


@pytest.fixture
def human():
    description = load_robot("human")
    body = WholeBody(description, G)
    joints = np.array(description.start_position)
    for index, name in enumerate(description.joint_names):
        joints[index] = {"knee": 0.8, "hip_pitch": -0.4, "ankle_pitch": -0.4}.get(
            name.split("_", 1)[-1], joints[index]
        )
    posture = standing(body.robot, joints)
    estimate = empty_estimate(len(joints))
    for key in ("base_position", "base_orientation", "joint_position"):
        getattr(estimate, key)[:] = getattr(posture, key)
    estimate.contact[:] = True
    body.set_state(estimate)
    return description, body, BodyTasks(description, body, joints), estimate


def com_acceleration(body):
    """Of the accelerations found, by the rows of the free base: M q̈ + h - m g = m a."""
    rows = body.mass_matrix[body.base][:3]
    force = rows @ body.acceleration + body.bias[body.base][:3]
    return force / body.robot.mass - np.array((0.0, 0.0, G))


def test_in_the_air_the_centre_of_mass_falls_whatever_the_feet_do(human):
    _, body, tasks, estimate = human
    ankles = np.array(body.robot.ankles)
    task = tasks.air(estimate, ankles + 0.05, np.zeros((2, 3)), np.full((2, 3), 3.0))
    body.torques(task)
    assert com_acceleration(body) == pytest.approx([0.0, 0.0, -G], abs=1e-6)


def test_on_the_ground_the_wanted_acceleration_is_had_and_the_feet_stay(human):
    _, body, tasks, estimate = human
    wanted = np.array([0.4, 0.1, 3.0])
    body.torques(tasks.ground(estimate, wanted, np.array([True, True])))
    assert com_acceleration(body) == pytest.approx(wanted, abs=0.05)
    assert body.forces[..., 2].sum() == pytest.approx(70.4 * (G + 3.0), rel=0.01)
    assert np.abs(body.foot_jacobian @ body.acceleration).max() < 0.3


def test_bent_knees_carry_the_trunk(human):
    description, body, tasks, estimate = human
    torque = body.torques(tasks.ground(estimate, np.zeros(3), np.array([True, True])))
    knee = torque[description.joint_names.index("left_knee")]
    fast = body.torques(tasks.ground(estimate, np.array([0, 0, G]), np.array([True, True])))
    assert abs(knee) > 15.0
    assert fast[description.joint_names.index("left_knee")] == pytest.approx(2 * knee, rel=0.15)


def test_a_cautious_foot_takes_no_more_than_its_leg_carries(human):
    description, body, tasks, estimate = human
    knees = [description.joint_names.index(f"{side}_knee") for side in ("left", "right")]
    limit = description.joints[knees[0]].torque_limit
    hard = np.array([0.0, 2.0, 2.5 * G])  # leans on one leg
    bearing = np.array([True, True])
    task = tasks.ground(estimate, hard, bearing)
    assert np.abs(body.torques(task)[knees]).max() > 1.3 * limit
    task.cautious = True
    assert np.abs(body.torques(task)[knees]).max() < limit
    assert body.forces[..., 2].sum() > 70.4 * G
