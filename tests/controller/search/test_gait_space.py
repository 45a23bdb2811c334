"""The variables of the gait search, from robot files and back."""

import pytest

from controller.search import gait_space
from hil.errors import InputError, UnknownNameError
from hil.robot_files import load_robot

KINDS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
LIMITS = dict.fromkeys(KINDS, ((0.1, 100.0), (0.83, 1.7)))


def changes(space, vector):
    return tuple(f"{key}={value!r}" for key, value in space.values(vector).items())


def test_a_zero_vector_is_the_robot_as_it_is():
    robot = load_robot("human")
    variables = gait_space.pose_variables(robot)
    space = gait_space.GaitSpace(robot, variables)
    again = load_robot("human", changes(space, [0.0] * len(variables)))
    assert again.walking["key_poses"] == robot.walking["key_poses"]


def test_a_key_point_moves_by_its_spread_and_the_phase_stays():
    robot = load_robot("human")
    variables = gait_space.pose_variables(robot)
    names = [variable.name for variable in variables]
    space = gait_space.GaitSpace(robot, variables)
    vector = [0.0] * len(names)
    vector[names.index("key_poses.swing_drop[2]")] = 0.5
    moved = load_robot("human", changes(space, vector)).walking["key_poses"]
    assert moved["swing_drop"][2] == [0.41, pytest.approx(0.806 + 0.02)]
    assert moved["swing_foot"] == [list(knot) for knot in robot.walking["key_poses"]["swing_foot"]]


def test_gains_of_both_rates_move_together_inside_the_registers():
    robot = load_robot("minibiped")
    variables = gait_space.gain_variables(robot, (300, 225), LIMITS, ("knee.kp", "knee.kd"))
    space = gait_space.GaitSpace(robot, variables)
    low, high = space.bounds()
    assert all(a <= 0.0 <= b for a, b in zip(low, high, strict=True))
    top = load_robot("minibiped", changes(space, high))
    for rate in (300, 225):
        assert top.gains[rate]["knee"] == (pytest.approx(100.0), pytest.approx(1.7))
        assert top.gains[rate]["hip_roll"] == robot.gains[rate]["hip_roll"]


def test_numbers_of_the_gait_stay_within_their_bounds():
    robot = load_robot("minibiped")
    variables = gait_space.gait_variables(robot)
    space = gait_space.GaitSpace(robot, variables)
    low, _ = space.bounds()
    lowest = load_robot("minibiped", changes(space, low))
    height = robot.walking["swing"]["height"]
    assert lowest.walking["swing"]["height"] == pytest.approx(0.6 * height, abs=1e-6)


def test_what_is_no_number_is_refused():
    robot = load_robot("minibiped")
    with pytest.raises(InputError, match=r"walking\.swing: only a number"):
        gait_space.gait_variables(robot, ("swing",))
    with pytest.raises(InputError, match=r"no walking\.swing\.colour"):
        gait_space.gait_variables(robot, ("swing.colour",))
    with pytest.raises(UnknownNameError, match=r"elbow\.kp"):
        gait_space.gain_variables(robot, (300,), LIMITS, ("elbow.kp",))
    bare = robot.model_copy(update={"gains": {}})
    with pytest.raises(InputError, match="there are no sets"):
        gait_space.gain_variables(bare, (300,), LIMITS)
