"""minibiped: the checked-in model is the derivation's, and the robot is what its page says."""

import mujoco
import numpy as np
import pytest

from hil.robot_files import load_robot
from hil.robots.minibiped.derivation import mjcf


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_path(str(load_robot("minibiped").model_path))


def test_checked_in_model_is_what_the_derivation_writes():
    assert load_robot("minibiped").model_path.read_text() == mjcf()


def test_masses_of_the_parts_page(model):
    def mass(body):
        return float(model.body(body).mass[0])

    assert mass("torso") == pytest.approx(1.25, abs=1e-3)
    assert mass("left_thigh") == pytest.approx(0.132, abs=1e-3)
    assert mass("left_shank") == pytest.approx(0.127, abs=1e-3)
    assert mass("left_foot") == pytest.approx(0.125, abs=1e-3)
    assert model.body_mass.sum() == pytest.approx(2.62, abs=1e-3)


def test_left_and_right_mirror_each_other(model):
    for body in ("hip_yaw_link", "hip_roll_link", "thigh", "shank", "ankle", "foot"):
        left, right = model.body(f"left_{body}"), model.body(f"right_{body}")
        assert left.mass == right.mass
        assert np.allclose(left.inertia, right.inertia)
        assert np.allclose(left.pos * [1, -1, 1], right.pos)


def test_description_and_model_name_the_same_joints_and_ranges(model):
    description = load_robot("minibiped")
    names = [model.joint(i).name for i in range(1, model.njnt)]
    assert names == list(description.joint_names)
    for joint in description.joints:
        assert tuple(model.joint(joint.name).range) == pytest.approx(joint.range)


def test_centre_of_mass_in_the_start_pose(model):
    data = mujoco.MjData(model)
    data.qpos[7:] = load_robot("minibiped").start_position
    mujoco.mj_forward(model, data)
    sole = min(data.xpos[model.body(f"{side}_foot").id, 2] for side in ("left", "right")) - 0.036
    ankle = data.xanchor[model.joint("left_ankle_roll").id]
    com = data.subtree_com[0]
    assert com[2] - sole == pytest.approx(0.2236, abs=1e-3)
    assert com[0] - ankle[0] == pytest.approx(0.004, abs=1e-3)
