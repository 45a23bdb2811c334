"""Head and hands of a recorded pose, against MuJoCo asked directly."""

import mujoco
import numpy as np
import pytest

from controller.search.motion import MotionMeter
from hil.robot_files import load_robot


def turned(yaw):
    return np.array([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])


def measured(meter, description, yaw=0.0, **joints):
    position = np.zeros((1, len(description.joints)))
    for name, value in joints.items():
        position[0, description.joint_names.index(name)] = value
    columns = meter.measure(
        np.array([[3.0, 4.0, 1.035]]), turned(yaw)[None], position, np.array([yaw])
    )
    return {name: column[0] for name, column in columns.items()}


@pytest.fixture(scope="module")
def human():
    return load_robot("human")


def test_the_head_is_where_the_model_has_it_whichever_way_the_body_looks(human):
    meter = MotionMeter(human)
    model = mujoco.MjModel.from_xml_path(str(human.model_path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    head = data.body("head").xpos - data.body("pelvis").xpos
    for yaw in (0.0, 2.0):
        found = measured(meter, human, yaw)
        assert found["head_height"] == pytest.approx(1.035 + head[2])
        assert found["head_forward"] == pytest.approx(head[0])
        assert found["head_left"] == pytest.approx(head[1], abs=1e-12)
        assert found["head_pitch"] == pytest.approx(0.0, abs=1e-12)


def test_the_necks_rotation_is_read_with_its_sign(human):
    meter = MotionMeter(human)
    found = measured(meter, human, 1.0, neck_pitch=0.1)
    assert found["head_pitch"] == pytest.approx(0.1)
    assert measured(meter, human, neck_roll=0.1)["head_roll"] == pytest.approx(0.1)


def test_hands_of_a_straight_arm_are_a_whole_arm_away_from_their_targets(human):
    found = measured(MotionMeter(human), human, yaw=0.7)
    fore = np.array([0.0, 0.15, 0.0])
    tip = np.array([-0.025 + 0.02 + 0.006, 0.37 + 0.39, 0.4 + 0.07]) + fore  # from the MJCF
    distance = np.linalg.norm(tip - [0.19, 0.16, 0.365])
    assert found["hands"] == pytest.approx([distance, distance])


def test_a_robot_without_head_and_hands_is_judged_by_its_trunk():
    biped = load_robot("minibiped")
    meter = MotionMeter(biped)
    columns = meter.measure(
        np.array([[0.0, 0.0, 0.4]]), turned(0.0)[None], np.zeros((1, 12)), np.zeros(1)
    )
    assert columns["head_height"] == pytest.approx([0.4])
    assert "hands" not in columns
    assert meter.scale == pytest.approx(0.22 / 0.93, rel=0.02)
