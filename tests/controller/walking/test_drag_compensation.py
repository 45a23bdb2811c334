"""Drag compensation against the simulated liquid, and against MuJoCo's own mapping of forces."""

import mujoco
import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.drag_compensation import DragCompensation
from controller.walking.drag_strips import strips
from controller.walking.joint_groups import JointGroups
from controller.walking.liquid import Liquid
from sim_backends.water.hydrodynamics import Hydrodynamics

from .conftest import random_state

LEVEL = 0.75
WATER = Liquid(LEVEL)
THICK = Liquid(LEVEL, 1000.0, 4.0)
FORWARD, LEFT, UP = np.eye(3)
ASIDE = 0.2
"""Coronal speed at which all drag across is carried [m/s]."""


def joint_drag(robot, groups, swing):
    """Joint torques of the plant's drag on the swing leg, by its fine surface elements."""
    model = robot.model
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = robot.data.qpos, robot.data.qvel
    mujoco.mj_step1(model, data)
    liquid = Hydrodynamics(model, data, robot.root_body, 0.02)
    liquid.set_medium(LEVEL, WATER.density, 1.0)
    liquid.act()
    hip = groups.legs("hip")[swing]
    felt = np.zeros(model.nv)
    for body, wrench in zip(liquid.bodies, liquid.wrenches, strict=True):
        if groups.moves([body])[0, hip]:
            mujoco.mj_applyFT(model, data, *wrench, data.xipos[body], int(body), felt)
    leg = groups.descends()[:, hip][groups.of_joint]
    return felt[robot.dof_addresses], leg


@pytest.mark.parametrize("swing", [0, 1])
def test_it_carries_the_drag_that_the_simulated_liquid_puts_on_the_swing_leg(human, swing):
    """Strips against elements of 2 cm, twenty random motions: 10 % of the torque in the mean."""
    robot = RobotModel(human)
    groups = JointGroups(human, robot)
    compensation = DragCompensation(robot, groups)
    wanted, given = [], []
    for seed in range(20):
        robot.set_state(random_state(human, seed, speed=0.6))
        drag, leg = joint_drag(robot, groups, swing)
        torques = sum(
            compensation.torques(swing, WATER, axis, ASIDE) for axis in (FORWARD, LEFT, UP)
        )
        joints = groups.project(torques, robot.joint_axes)
        assert not joints[~leg].any()
        wanted.append(-drag[leg])
        given.append(joints[leg])
    error = np.abs(np.subtract(given, wanted)).sum() / np.abs(wanted).sum()
    assert np.abs(wanted).max() > 5.0
    assert error < 0.12


def test_a_leg_at_rest_and_a_dry_leg_need_nothing(human, placed):
    groups, robot = placed.groups, placed.robot
    compensation = DragCompensation(robot, groups)
    assert not compensation.torques(0, THICK, LEFT, ASIDE).any()
    robot.set_state(random_state(human, seed=3))
    assert compensation.torques(0, THICK, LEFT, ASIDE).any()
    assert not compensation.torques(0, Liquid(-1.0, 1000.0, 4.0), LEFT, ASIDE).any()


def test_ahead_it_carries_what_exceeds_water_and_sideways_everything(human, placed):
    robot = placed.robot
    compensation = DragCompensation(robot, placed.groups)
    robot.set_state(random_state(human, seed=3))
    of_water = {
        tuple(axis): compensation.torques(0, WATER, axis, ASIDE) for axis in (FORWARD, LEFT, UP)
    }
    excess = 3.0 * sum(of_water.values())
    np.testing.assert_allclose(
        compensation.torques(0, THICK, LEFT, ASIDE), excess + of_water[tuple(LEFT)], atol=1e-9
    )


def test_strips_show_what_the_solid_shows(human):
    """Along its axes: a box its faces, a capsule its outline."""
    model = RobotModel(human).model
    _, sole = strips(model, model.geom("left_sole").id, 0.05)
    x, y, z = model.geom("left_sole").size
    np.testing.assert_allclose(sole.sum(axis=0), (4 * y * z, 4 * x * z, 4 * x * y))
    _, thigh = strips(model, model.geom("left_thigh").id, 0.05)
    radius, half = model.geom("left_thigh").size[:2]
    round_end = np.pi * radius**2
    outline = 4.0 * radius * half + round_end
    np.testing.assert_allclose(thigh.sum(axis=0), (outline, outline, round_end))


def test_a_walk_that_goes_straight_keeps_the_drag_its_poses_are_made_for(human, placed):
    robot = placed.robot
    compensation = DragCompensation(robot, placed.groups)
    robot.set_state(random_state(human, seed=3))
    assert not compensation.torques(0, WATER, LEFT, 0.0).any()
    half = compensation.torques(0, WATER, LEFT, 0.05)
    assert 0.0 < np.abs(half).max() < np.abs(compensation.torques(0, WATER, LEFT, ASIDE)).max()
