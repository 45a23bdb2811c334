"""Implicit PD, and the linearised law behind it against differences of the law itself."""

import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.implicit_pd import ImplicitPd
from controller.walking.joint_groups import JointGroups
from controller.walking.linear_law import LinearLaw
from controller.walking.pose_tracking import PoseTracking
from controller.walking.root_balance import hip_moment

from .conftest import random_state

SHARES = (0.7, 0.3)
H = 0.004


class Law:
    """Pose tracking and root balance of a human on its left foot, as torques of the joints."""

    def __init__(self, human, config):
        self.robot = RobotModel(human)
        self.groups = JointGroups(human, self.robot)
        self.tracking = PoseTracking(self.robot, self.groups, config, config.gains[300])
        self.hips = (self.groups.index("left_hip"), self.groups.index("right_hip"))
        self.trunk = np.array([self.groups.index("back")])

    def torques(self, state):
        self.robot.set_state(state)
        self.tracking.set_frames(np.eye(3), {})
        for _ in range(2):  # the root's rate is the mean of two ticks
            torques = self.tracking.torques()
        stance, swing = self.hips
        moment = hip_moment(torques[-1], torques[swing], torques[self.trunk])
        torques[stance] = SHARES[0] * moment
        torques[swing] += SHARES[1] * moment
        return self.groups.project(torques[:-1], self.robot.joint_axes)


def test_linear_law_is_the_derivative_of_the_law(human, human_config):
    """With lead 0 the law's only velocity term is −A·q̇: the matrix of kd is A without kp."""
    config = human_config.model_copy(
        update={"gains": {300: {k: (0.0, d) for k, (_, d) in human_config.gains[300].items()}}}
    )
    law = Law(human, config)
    state = random_state(human, seed=5, speed=0.1)
    base = law.torques(state)
    linear = LinearLaw(law.robot, law.groups, law.tracking, law.trunk)
    matrix = linear.matrix(law.tracking.damping[:, None, :], law.hips, SHARES)
    coupling = matrix[law.robot.dof_addresses]
    step = 1e-3
    for joint, dof in enumerate(law.robot.dof_addresses):
        state.joint_velocity[joint] += step
        derivative = (law.torques(state) - base) / step
        state.joint_velocity[joint] -= step
        assert -derivative == pytest.approx(coupling[:, dof], abs=1e-6), human.joint_names[joint]
    for axis in range(3):
        state.base_angular_velocity[axis] += step
        derivative = (law.torques(state) - base) / step
        state.base_angular_velocity[axis] -= step
        assert -derivative == pytest.approx(coupling[:, 3 + axis], abs=1e-6)
    assert not coupling[:, :3].any()


def test_contact_force_is_observed_from_the_last_tick(human, human_config):
    """A body in free fall that follows its own dynamics shows no contact force."""
    law = Law(human, human_config)
    robot = law.robot
    implicit = ImplicitPd(robot, law.groups, law.tracking, law.trunk, H)
    state = random_state(human, seed=6, speed=0.1)
    torques = law.torques(state)
    applied = np.zeros(robot.model.nv)
    applied[robot.dof_addresses] = implicit.correct(torques, law.hips, SHARES)
    acceleration = np.linalg.solve(implicit._mass, applied - implicit._bias)
    robot.data.qvel[:] += H * acceleration
    assert implicit._observed_force() == pytest.approx(np.zeros(robot.model.nv), abs=1e-8)
    robot.data.qvel[2] += H * 10.0
    assert implicit._observed_force()[2] == pytest.approx(704.0, rel=1e-3)
