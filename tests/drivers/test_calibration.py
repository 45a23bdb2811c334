"""The calibration: what distinguishes two, how it is written, and that applying it undoes it."""

import math
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.boards.calibration import (
    FootCalibration,
    FootConverter,
    ImuCalibration,
    ImuConverter,
)
from drivers.boards.frames import FootFrame, ImuFrame
from drivers.calibration import RobotCalibration, load_calibration, save_calibration
from drivers.dynamixel.states import ServoStates
from drivers.joint_converter import JointConverter
from hil.errors import InputError
from hil.interface import SensorFrame
from hil.robot_files import load_robot

CONTENT = {
    "robot": "minibiped",
    "provenance": {"date": "2026-01-02", "method": "ideal"},
    "joint_offsets": {"left_knee": 0.1, "right_knee": -0.2},
    "joint_ranges": {"left_hip_yaw": [-0.3, 0.9]},
    "feet": {"left": {"zero": [1, 2, 3, 4], "scale": [0.1, -0.1, 0.2, 0.3]}},
}
ROBOT = load_robot("minibiped")


def calibration(**changes):
    return RobotCalibration.model_validate({**CONTENT, **changes})


# Identity ------------------------------------------------------------------------------------


def test_the_identity_is_that_of_the_values_and_not_of_their_writing(tmp_path):
    one = calibration()
    offsets = dict(reversed(CONTENT["joint_offsets"].items()))
    later = {"date": "2026-03-04", "method": "other", "software": "newer"}
    other = calibration(joint_offsets=offsets, provenance=later, measured={"imu": later},
                        agreed="0")  # fmt: skip
    assert one.identity() == other.identity()
    save_calibration(one, tmp_path / "a.yaml")
    assert load_calibration(tmp_path / "a.yaml").identity() == one.identity()


def test_the_identity_of_a_known_calibration_never_changes():
    """Recorded hoisted walks refer to it: a change of its form would make all of them void."""
    assert calibration().identity() == "8cf11355c5100d9e"


@pytest.mark.parametrize(
    "changes",
    [
        {"robot": "other"},
        {"joint_offsets": {"left_knee": 0.1001, "right_knee": -0.2}},
        {"joint_offsets": {"left_knee": 0.1}},
        {"joint_ranges": {}},
        {"feet": {}},
        {"imu": {"mounting": [0, 1, 0, 0]}},
        {"imu": {"gyro_bias": [0.001, 0, 0]}},
    ],
)
def test_any_other_value_is_another_identity(changes):
    assert calibration(**changes).identity() != calibration().identity()


# The file ------------------------------------------------------------------------------------


def test_a_file_that_cannot_be_written_whole_stays_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "mine.yaml"
    save_calibration(calibration(), path)
    before = path.read_bytes()

    def full_disk(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(InputError, match="No space left on device"):
        save_calibration(calibration(joint_offsets={}), path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_what_was_not_measured_is_named_once_anything_was():
    assert calibration().gaps(ROBOT) == ()
    record = {"date": "2026-01-02", "method": "by hand", "parts": {"left_knee": "XM430-W350"}}
    gaps = calibration(measured={"joints": record}).gaps(ROBOT)
    assert "joint left_hip_yaw" in gaps
    assert "joint left_knee" not in gaps
    assert gaps[-2:] == ("imu", "right foot")
    with pytest.raises(InputError, match="measured: not yet: joint left_hip_yaw"):
        calibration(measured={"joints": record}).require_whole(ROBOT)


def test_the_narrower_range_counts():
    low, high = calibration().ranges(ROBOT)
    assert (low[0], high[0]) == (-0.3, 0.8)
    assert (low[3], high[3]) == ROBOT.joints[3].range


# Applying it ---------------------------------------------------------------------------------


@given(
    offsets=st.lists(st.floats(-0.78, 0.78), min_size=12, max_size=12),
    directions=st.lists(st.sampled_from([-1, 1]), min_size=12, max_size=12),
    angles=st.lists(st.floats(-1.5, 1.5), min_size=12, max_size=12),
)
@settings(max_examples=50, deadline=None)
def test_offsets_and_directions_are_undone(offsets, directions, angles):
    """q = direction·(counts − 2048)·2π/4096 − offset, to half a count."""
    joints = tuple(
        joint.model_copy(update={"direction": direction})
        for joint, direction in zip(ROBOT.joints, directions, strict=True)
    )
    robot = ROBOT.model_copy(update={"joints": joints})
    own = calibration(joint_offsets=dict(zip(robot.joint_names, offsets, strict=True)))
    turned = np.array(directions) * (np.array(angles) + offsets)
    states = ServoStates.empty(12)
    states.position[:] = np.rint(2048 + turned * 4096 / (2 * math.pi))
    frame = SensorFrame.empty(12)
    JointConverter(robot, own).convert(states, frame)
    assert frame.joint_position == pytest.approx(angles, abs=math.pi / 4096 + 1e-9)


@given(
    zero=st.lists(st.integers(-(10**6), 10**6), min_size=4, max_size=4),
    gain=st.lists(st.floats(200, 4000), min_size=4, max_size=4),
    sign=st.sampled_from([-1, 1]),
    force=st.lists(st.floats(-20, 100), min_size=4, max_size=4),
)
@settings(max_examples=50, deadline=None)
def test_zero_and_scale_of_cells_are_undone(zero, gain, sign, force):
    gain = sign * np.array(gain)
    counts = tuple(int(c) for c in np.rint(zero + gain * force))
    found = np.zeros(4)
    own = FootCalibration(zero=tuple(zero), scale=tuple(1 / gain))
    FootConverter(own).convert(FootFrame(0, 0, 0xF, counts), found)
    assert found == pytest.approx(force, abs=0.5 / 200 + 1e-9)


@given(quaternion=st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(
    lambda q: np.linalg.norm(q) > 0.1))  # fmt: skip
@settings(max_examples=50, deadline=None)
def test_mounting_and_bias_of_an_imu_are_undone(quaternion):
    """A sensor turned by M on a base at rest, tilted: it says S = B·M, Mᵀ·f and Mᵀ·ω + b."""
    m = np.array(quaternion) / np.linalg.norm(quaternion)
    base = np.array([math.cos(0.2), math.sin(0.2), 0.0, 0.0])
    rate, force, bias = np.array([0.3, -0.2, 0.1]), np.array([1.0, 2.0, 9.0]), (0.05, -0.02, 0.01)
    back = _matrix(m).T
    frame = ImuFrame(
        0, 0, 7,
        tuple(np.rint(16384 * _product(base, m)).astype(int).tolist()),
        tuple(np.rint(np.degrees(back @ rate + bias) * 32768 / 2000).astype(int).tolist()),
        tuple(np.rint(back @ force * 32768 / (8 * 9.80665)).astype(int).tolist()),
    )  # fmt: skip
    found = np.zeros(4), np.zeros(3), np.zeros(3)
    ImuConverter(ImuCalibration(mounting=tuple(m), gyro_bias=bias)).convert(frame, *found)
    assert abs(float(np.dot(found[0], base))) == pytest.approx(1.0, abs=1e-6)
    assert found[1] == pytest.approx(rate, abs=2e-3)
    assert found[2] == pytest.approx(force, abs=5e-3)


def _product(a, b):
    w, x, y, z = a
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]) @ b


def _matrix(q):
    return np.array([_product(_product(q, [0, *axis]), q * [1, -1, -1, -1])[1:]
                     for axis in np.eye(3)]).T  # fmt: skip
