"""Registers out of a recording: those that were written, on whatever robot replays them."""

import numpy as np
import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.dynamixel.replayed_goals import ReplayedGoals
from hil.errors import InputError
from hil.interface import JointCommand, SensorFrame
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN

N, KNEE = 12, 3


def robot(**knee):
    description = load_robot("minibiped")
    joints = tuple(
        joint.model_copy(update=knee) if joint.name == "left_knee" else joint
        for joint in description.joints
    )
    return description.model_copy(update={"joints": joints})


def calibration(**offsets):
    provenance = {"date": "2026-01-01", "method": "ideal"}
    data = {"robot": "minibiped", "provenance": provenance, "joint_offsets": offsets}
    return RobotCalibration.model_validate(data)


def written():
    """Registers of a command with torque and velocity, and what was recorded of it."""
    mapping, n = GainMapping(robot(), calibration()), np.arange(N)
    command = JointCommand(0.2 + 0.01 * n, 0.1 * n, np.full(N, 18.9), np.full(N, 0.851), 0.05 * n)
    goals, applied = mapping.map(command, SensorFrame.empty(N))
    return goals, applied


def replayed(description, own, applied):
    replay = ReplayedGoals(description, own)
    replay.applied.goal[:], replay.applied.p_gain[:] = applied.goal, applied.p_gain
    goals, same = replay.map(JointCommand.zeros(N), SensorFrame.empty(N))
    assert same is replay.applied
    return goals


def test_the_registers_are_those_of_the_run():
    goals, applied = written()
    again = replayed(robot(), calibration(), applied)
    assert np.array_equal(again.position, goals.position)
    assert np.array_equal(again.p_gain, goals.p_gain)
    assert np.array_equal(again.d_gain, goals.d_gain)
    assert np.array_equal(again.pwm_limit, goals.pwm_limit)
    assert not np.array_equal(applied.goal, applied.position)  # the shift is in it


def test_another_robots_offset_and_direction_count():
    goals, applied = written()
    shifted = replayed(robot(), calibration(left_knee=0.1), applied)
    assert shifted.position[KNEE] - goals.position[KNEE] == round(0.1 * COUNTS_PER_RADIAN)
    mirrored = replayed(robot(direction=-1), calibration(), applied)
    assert mirrored.position[KNEE] - 2048 == -(goals.position[KNEE] - 2048)


def test_only_position_mode_is_replayed():
    with pytest.raises(InputError, match=r"left_knee.*position"):
        ReplayedGoals(robot(mode="current"), calibration())
