"""Gain sets by control rate: which one is taken, what a robot file may say."""

import pytest
import yaml

from hil.compose import build
from hil.errors import DescriptionError, UnknownNameError
from hil.joint_gains import kind_of, set_for
from hil.request import RunRequest
from hil.robot_files import find_robot_file, load_robot


def test_a_rate_takes_the_highest_set_not_above_it():
    assert [set_for((225, 300), rate) for rate in (1000, 300, 299, 225, 100)] == [
        300, 300, 225, 225, 225,
    ]  # fmt: skip


def test_joints_lose_their_side_only():
    assert kind_of("left_hip_yaw") == "hip_yaw"
    assert kind_of("root") == "root"
    assert kind_of("leftover") == "leftover"


def test_servo_joints_take_the_gains_of_the_rate():
    changes = ("gains.300.knee=[20.0, 0.9]", "gains.225.knee=[15.0, 0.86]")
    robot = load_robot("minibiped", changes)
    for rate, pair in ((300, (20.0, 0.9)), (250, (15.0, 0.86))):
        joints = {joint.name: joint for joint in robot.at_rate(rate).joints}
        assert (joints["left_knee"].stiffness, joints["left_knee"].damping) == pair
        assert (joints["right_knee"].stiffness, joints["right_knee"].damping) == pair


def test_a_walk_sends_the_gains_of_its_rate():
    request = RunRequest.checked(
        robot="minibiped", backend="mujoco", rate_hz=225, overrides=("gains.225.knee=[15.0, 0.86]",)
    )
    session = build(request)
    try:
        knee = session.description.joint_names.index("left_knee")
        assert session.description.joints[knee].stiffness == 15.0
    finally:
        session.close()


def test_a_set_beyond_the_registers_is_refused():
    request = RunRequest.checked(
        robot="minibiped", backend="mujoco", overrides=("gains.300.knee=[20.0, 5.0]",)
    )
    with pytest.raises(Exception, match=r"left_knee: XM430-W350 cannot have damping 5"):
        build(request)


def test_a_set_of_an_unknown_joint_is_refused(tmp_path):
    data = yaml.safe_load(find_robot_file("minibiped").read_text(encoding="utf-8"))
    data["gains"][300]["elbow"] = [1.0, 1.0]
    file = tmp_path / "robot.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(DescriptionError, match=r"gains\.300 names no joint of this robot: elbow"):
        load_robot(str(file))


def test_an_unknown_set_is_refused():
    with pytest.raises(UnknownNameError, match=r"gains\.100\.knee"):
        load_robot("minibiped", ("gains.100.knee=[1, 1]",))
