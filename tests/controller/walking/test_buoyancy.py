"""Buoyancy compensation against MuJoCo's own mapping of forces onto joints."""

import mujoco
import numpy as np
import pytest

from controller.walking.buoyancy import BuoyancyCompensation
from controller.walking.gravity_compensation import GravityCompensation
from hil.submerged import SubmergedParts


@pytest.mark.parametrize("stance", [0, 1])
@pytest.mark.parametrize("level", [0.4, 0.9, 3.0])
def test_it_takes_up_the_lift_of_every_part_but_the_stance_leg(placed, stance, level):
    """Joint torques against −Jᵀ of the lifts at their centroids, outside the stance leg."""
    robot, groups = placed.robot, placed.groups
    torques = BuoyancyCompensation(robot, groups).torques(stance, level, 1000.0)
    parts = SubmergedParts(robot.model, robot.data, robot.root_body, robot.leg_length / 24)
    parts.update(level)
    lifted = np.zeros(robot.model.nv)
    for body, volume, centre in zip(parts.bodies, parts.volumes, parts.centres, strict=True):
        force = np.array([0.0, 0.0, 1000.0 * robot.gravity * volume])
        mujoco.mj_applyFT(
            robot.model, placed.reference, force, np.zeros(3), centre, int(body), lifted
        )
    joints = groups.project(torques, robot.joint_axes)
    leg = groups.descends()[:, groups.legs("hip")[stance]][groups.of_joint]
    assert np.abs(lifted).max() > 1.0
    np.testing.assert_allclose(joints[~leg], -lifted[robot.dof_addresses][~leg], atol=1e-9)
    assert not joints[leg].any()


def test_a_robot_as_light_as_the_liquid_needs_no_support(placed):
    """Weight and lift cancel: the swing thigh alone, under water at the density of its volume."""
    robot, groups = placed.robot, placed.groups
    elbow = groups.index("left_elbow")
    forearm = int(groups.child[elbow])
    parts = SubmergedParts(robot.model, robot.data, robot.root_body, robot.leg_length / 24)
    parts.update(5.0)
    volume = float(parts.volumes[parts.bodies == forearm][0])
    density = float(robot.model.body_mass[forearm]) / volume
    lift = BuoyancyCompensation(robot, groups).torques(0, 5.0, density)[elbow]
    weight = GravityCompensation(robot, groups).torques(0)[elbow]
    np.testing.assert_allclose(lift, -weight, atol=1e-6 * np.abs(weight).max() + 1e-9)
