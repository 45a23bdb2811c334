"""The swing leg's inertia torque against MuJoCo's inverse dynamics, which never builds M."""

import mujoco
import numpy as np
import pytest
from servo_bench import minibiped

from controller.robot_model import RobotModel
from controller.walking.leg_inertia import LegInertia

HIP_PITCH, KNEE = 2, 3
LEGS = np.arange(12).reshape(2, 6)


@pytest.fixture
def model():
    description = minibiped()
    model = RobotModel(description)
    model.data.qpos[model.qpos_addresses] = description.start_position
    mujoco.mj_kinematics(model.model, model.data)
    mujoco.mj_comPos(model.model, model.data)
    return model


def inverse(model, leg, acceleration):
    """Torque of one leg's accelerations with the torso held, gravity and velocities left out."""
    data, dofs = model.data, model.dof_addresses[LEGS[leg]]
    without, with_them = np.zeros((2, model.model.nv))
    mujoco.mj_rne(model.model, data, 1, without)
    data.qacc[dofs] = acceleration
    mujoco.mj_rne(model.model, data, 1, with_them)
    data.qacc[dofs] = 0.0
    return (with_them - without)[dofs] + model.model.dof_armature[dofs] * acceleration


@pytest.mark.parametrize("leg", [0, 1])
def test_torque_is_that_of_inverse_dynamics(model, leg):
    acceleration = np.array([3.0, -5.0, 40.0, -60.0, 25.0, 8.0])
    expected = inverse(model, leg, acceleration)
    np.testing.assert_allclose(LegInertia(model, LEGS).torque(leg, acceleration), expected)


def test_a_hip_that_speeds_up_needs_the_knee_to_hold_against_it(model):
    acceleration = np.zeros(6)
    acceleration[HIP_PITCH] = 50.0
    torque = LegInertia(model, LEGS).torque(0, acceleration)
    assert abs(torque[KNEE]) > 0.05 * abs(torque[HIP_PITCH])
    assert torque[KNEE] == pytest.approx(inverse(model, 0, acceleration)[KNEE])
