import math

import numpy as np
import pytest

from hil.interface import NEVER_NS, SensorFrame
from hil.record_layout import topics
from hil.robot_files import load_robot
from hil.safety import Supervisor, never_heard

ROBOT = load_robot("minibiped")


def fresh_frame():
    frame = SensorFrame.empty(12)
    frame.joint_age_ns[:] = 0
    frame.joint_valid[:] = True
    frame.imu_age_ns = 0
    frame.foot_age_ns[:] = 0
    return frame


def body(height=0.25, roll=0.0, pitch=0.0, yaw=0.0):
    motion = topics(12, truth=True)["truth"]
    motion.base_position = np.array([1.0, 2.0, height])
    half = np.array([roll, pitch, yaw]) / 2
    (cr, cp, cy), (sr, sp, sy) = np.cos(half), np.sin(half)
    motion.base_orientation = np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )
    return motion


def supervisor():
    judge = Supervisor(ROBOT)
    judge.begin_walking(0.25)
    return judge


@pytest.mark.parametrize("yaw", [0.0, 1.0, -3.0])
@pytest.mark.parametrize(
    ("pose", "fell"),
    [
        ({}, False),
        ({"roll": 0.99}, False),
        ({"roll": -1.01}, True),
        ({"pitch": 1.01}, True),
        ({"pitch": math.pi}, True),
        ({"height": 0.151}, False),
        ({"height": 0.149}, True),
    ],
)
def test_a_fall_is_a_tilt_of_one_radian_or_a_low_body(pose, fell, yaw):
    fault = supervisor().judge(3.0, fresh_frame(), body(yaw=yaw, **pose))
    assert (fault is not None) == fell
    if fault is not None:
        assert (fault.time_s, fault.name) == (3.0, "fell")


def test_a_servo_silent_for_five_ticks_is_forgiven_and_for_six_is_lost():
    judge, frame = supervisor(), fresh_frame()
    frame.joint_valid[3] = False
    assert [judge.judge(0.0, frame, body()) for _ in range(5)] == [None] * 5
    assert judge.judge(0.0, frame, body()).source == "left_knee"


def test_one_answer_makes_a_servo_heard_again():
    judge, frame = supervisor(), fresh_frame()
    for _ in range(10):
        frame.joint_valid[3] = False
        assert [judge.judge(0.0, frame, body()) for _ in range(5)] == [None] * 5
        frame.joint_valid[3] = True
        assert judge.judge(0.0, frame, body()) is None


def test_a_silent_board_is_lost_by_name():
    frame = fresh_frame()
    frame.foot_age_ns[1] = 60_000_000
    assert supervisor().judge(0.0, frame, body()).source == "right_foot"
    frame = fresh_frame()
    frame.imu_age_ns = 60_000_000
    assert supervisor().judge(0.0, frame, body()).source == "imu"
    frame.imu_present = False
    assert supervisor().judge(0.0, frame, body()) is None


def test_who_never_spoke_is_named():
    frame = fresh_frame()
    frame.joint_age_ns[11] = NEVER_NS
    frame.foot_age_ns[0] = NEVER_NS
    frame.imu_age_ns = NEVER_NS
    assert never_heard(ROBOT, frame) == ["right_ankle_roll", "imu", "left_foot"]
    assert never_heard(ROBOT, fresh_frame()) == []
