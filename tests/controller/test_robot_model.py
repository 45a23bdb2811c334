"""The controller's model against MuJoCo's own full computation of the same state."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.robot_files import load_robot


def state_of(description, seed):
    rng = np.random.default_rng(seed)
    n = len(description.joints)
    quaternion = np.array([1.0, *rng.uniform(-0.3, 0.3, 3)])
    return SimpleNamespace(
        base_position=rng.normal(size=3),
        base_orientation=quaternion / np.linalg.norm(quaternion),
        base_linear_velocity=rng.normal(size=3),
        base_angular_velocity=rng.normal(size=3),
        joint_position=rng.uniform(-0.5, 0.5, n),
        joint_velocity=rng.normal(size=n),
    )


@pytest.fixture(params=["human", "minibiped"])
def placed(request):
    description = load_robot(request.param)
    robot, state = RobotModel(description), state_of(description, seed=1)
    robot.set_state(state)
    data = mujoco.MjData(robot.model)
    data.qpos[:3], data.qpos[3:7] = state.base_position, state.base_orientation
    data.qvel[:3], data.qvel[3:6] = state.base_linear_velocity, state.base_angular_velocity
    for k, name in enumerate(description.joint_names):
        joint = robot.model.joint(name)
        data.qpos[joint.qposadr[0]] = state.joint_position[k]
        data.qvel[joint.dofadr[0]] = state.joint_velocity[k]
    mujoco.mj_forward(robot.model, data)
    mujoco.mj_subtreeVel(robot.model, data)
    return description, robot, data


def test_centre_of_mass_and_its_velocity(placed):
    description, robot, data = placed
    root = robot.model.body(description.root).id
    assert robot.com == pytest.approx(data.subtree_com[root])
    assert robot.com_velocity == pytest.approx(data.subtree_linvel[root])


def test_velocity_of_the_centre_of_mass_is_its_derivative(placed):
    description, robot, data = placed
    before, velocity = robot.com.copy(), robot.com_velocity.copy()
    step = 1e-6
    mujoco.mj_integratePos(robot.model, data.qpos, data.qvel, step)
    mujoco.mj_kinematics(robot.model, data)
    mujoco.mj_comPos(robot.model, data)
    root = robot.model.body(description.root).id
    assert (data.subtree_com[root] - before) / step == pytest.approx(velocity, abs=1e-4)


def test_corners_are_those_of_the_sole_boxes(placed):
    description, robot, data = placed
    corners = robot.corner_positions
    for side, name in enumerate(("left", "right")):
        geom = robot.model.geom(description.feet[name].sole)
        half = geom.size
        for k, signs in enumerate(((1, 1, -1), (1, -1, -1), (-1, 1, -1), (-1, -1, -1))):
            expected = data.geom_xpos[geom.id] + data.geom_xmat[geom.id].reshape(3, 3) @ (
                half * signs
            )
            assert corners[side, k] == pytest.approx(expected)


def test_leg_lengths():
    human, minibiped = RobotModel(load_robot("human")), RobotModel(load_robot("minibiped"))
    assert (human.thigh_length, human.shank_length) == pytest.approx((0.47, 0.46), abs=2e-4)
    assert human.mass == pytest.approx(70.4)
    assert human.knee_offset == pytest.approx(0.01 / 0.46, abs=1e-4)
    assert (minibiped.thigh_length, minibiped.shank_length) == pytest.approx((0.11, 0.11))
    assert minibiped.knee_offset == pytest.approx(0.0)


def test_unknown_root_body_is_named():
    data = load_robot("human").model_dump()
    wrong = RobotDescription.model_validate({**data, "root": "hull"})
    with pytest.raises(DescriptionError, match=r"human\.yaml: root: 'hull'"):
        RobotModel(wrong)
