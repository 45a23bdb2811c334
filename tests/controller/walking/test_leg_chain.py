"""Legs whose hip axes come in another order, are tilted, or pass each other."""

import itertools

import mujoco
import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.leg_chain import ORDER, LegChain, split
from hil.robot_files import find_robot_file, load_robot

POSE = (0.0, 0.0, -0.43, 0.86, -0.43, 0.0)


@pytest.fixture
def model_of(tmp_path):
    """minibiped's controller model, its MJCF changed by replacements."""

    def make(*changes):
        text = find_robot_file("minibiped").with_suffix(".xml").read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "minibiped.xml").write_text(text)
        file = tmp_path / "mine.yaml"
        file.write_text(find_robot_file("minibiped").read_text())
        return RobotModel(load_robot(str(file)))

    return make


def reached(model, leg, angles):
    """Ankle from the hip centre and foot rotation by MuJoCo, base upright at the origin."""
    model.place_at_zero()
    hip = model.hip_positions[leg].copy()
    side = ("left", "right")[leg]
    for name, angle in zip(ORDER, angles, strict=True):
        model.data.qpos[model.model.joint(f"{side}_{name}").qposadr[0]] = angle
    mujoco.mj_kinematics(model.model, model.data)
    return model.ankle_positions[leg] - hip, model.foot_rotations[leg]


VARIANTS = {
    "offset": [('"left_hip_roll" axis="1 0 0"', '"left_hip_roll" axis="1 0 0" pos="0 0 .012"')],
    "tilted": [('"left_hip_roll" axis="1 0 0"', '"left_hip_roll" axis="0.985 0 0.174"')],
    "order": [('"left_hip_yaw" axis="0 0 1"', '"left_swap" axis="0 1 0"'),
              ('"left_hip_pitch" axis="0 1 0"', '"left_hip_yaw" axis="0 0 1"'),
              ('"left_swap"', '"left_hip_pitch"')],
}  # fmt: skip


def test_minibiped_is_exact(model_of):
    model = model_of()
    assert LegChain(model, 0).exact and LegChain(model, 1).exact


@pytest.mark.parametrize("changes", VARIANTS.values(), ids=VARIANTS)
def test_the_foot_gets_where_it_should(model_of, changes):
    model = model_of(*changes)
    chain = LegChain(model, 0)
    assert not chain.exact
    rng = np.random.default_rng(5)
    for _ in range(20):
        angles = np.array(POSE) + rng.uniform(-0.15, 0.15, 6)
        ankle, foot = reached(model, 0, angles)
        ankle, foot = ankle.copy(), foot.copy()
        solved = chain.solve(ankle.tolist(), tuple(map(tuple, foot.tolist())))
        again, facing = reached(model, 0, solved)
        np.testing.assert_allclose(again, ankle, atol=2e-6)
        np.testing.assert_allclose(facing, foot, atol=2e-6)


def test_a_leg_that_was_out_of_reach_bends_again_at_once(model_of):
    """Corrections that went on growing while nothing could help left it straight."""
    level = tuple(map(tuple, np.eye(3).tolist()))
    model = model_of(*VARIANTS["offset"])
    chain = LegChain(model, 0)
    for _ in range(30):
        straight = chain.solve([0.05, 0.0, -0.28], level)
    assert straight[3] < 0.15
    ankle, _ = reached(model, 0, chain.solve([0.0, 0.0, -0.2], level))
    np.testing.assert_allclose(ankle, (0.0, 0.0, -0.2), atol=2e-6)


@pytest.mark.parametrize("axes", list(itertools.permutations((0, 1, 2))))
def test_angles_of_any_order_put_the_rotation_together_again(axes):
    angles = (0.4, -0.7, 1.1)
    turn = np.eye(3)
    for axis, angle in zip(axes, angles, strict=True):
        quaternion, matrix = np.zeros(4), np.zeros(9)
        mujoco.mju_axisAngle2Quat(quaternion, np.eye(3)[axis], angle)
        mujoco.mju_quat2Mat(matrix, quaternion)
        turn = turn @ matrix.reshape(3, 3)
    np.testing.assert_allclose(split(turn.tolist(), *axes), angles, atol=1e-12)
