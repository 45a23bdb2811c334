import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hil.errors import InvalidCommandError
from hil.interface import JointCommand, Limit
from hil.limits import JointLimits
from hil.robot_files import load_robot

ROBOT = load_robot("minibiped")
N = len(ROBOT.joints)
LOW = np.array([joint.range[0] for joint in ROBOT.joints])
HIGH = np.array([joint.range[1] for joint in ROBOT.joints])
finite = st.floats(allow_nan=False, allow_infinity=False)
command_values = arrays(np.float64, (5, N), elements=finite)


@given(command_values)
def test_whatever_finite_command_comes_what_leaves_is_inside_the_limits(values):
    out = JointLimits(ROBOT).apply(JointCommand(*values))
    assert np.all((out.position >= LOW) & (out.position <= HIGH))
    assert np.all(np.abs(out.velocity) <= [joint.velocity_limit for joint in ROBOT.joints])
    assert np.all(np.abs(out.torque) <= [joint.torque_limit for joint in ROBOT.joints])
    assert np.all(out.stiffness >= 0) and np.all(out.damping >= 0)


@given(command_values)
def test_a_flag_is_up_exactly_where_a_value_was_changed(values):
    command = JointCommand(*values)
    limits = JointLimits(ROBOT)
    out = limits.apply(command)
    for field, flag in (
        ("velocity", Limit.VELOCITY),
        ("torque", Limit.TORQUE),
        ("stiffness", Limit.STIFFNESS),
        ("damping", Limit.DAMPING),
    ):
        changed = getattr(out, field) != getattr(command, field)
        assert np.array_equal((limits.flags & flag) != 0, changed)


def test_a_command_inside_its_limits_passes_unchanged():
    command = JointCommand(*(np.full(N, value) for value in (0.1, -1.0, 18.9, 0.8, 2.0)))
    limits = JointLimits(ROBOT)
    out = limits.apply(command)
    for field in ("position", "velocity", "stiffness", "damping", "torque"):
        assert np.array_equal(getattr(out, field), getattr(command, field))
    assert not limits.flags.any()


STEP = ROBOT.safety.goal_speed_max / 300 * np.array([j.velocity_limit for j in ROBOT.joints])
positions = arrays(np.float64, (12, N), elements=finite)


@given(positions)
def test_a_goal_moves_no_further_in_a_tick_than_it_may_and_stays_in_its_range(goals):
    limits, last = JointLimits(ROBOT, 300), None
    command = JointCommand.zeros(N)
    command.stiffness[:] = 10.0
    for goal in goals:
        command.position[:] = goal
        out = limits.apply(command)
        assert np.all((out.position >= LOW) & (out.position <= HIGH))
        ranged = np.clip(goal, LOW, HIGH)
        if last is not None:
            assert np.all(np.abs(out.position - last) <= STEP * (1 + 1e-12))
            # It goes as far as it may, and no limit is told that did nothing.
            expected = np.clip(ranged, last - STEP, last + STEP)
            assert np.array_equal(out.position, expected)
        fast = (limits.flags & Limit.VELOCITY) != 0
        assert np.array_equal(fast, out.position != ranged)
        assert np.array_equal((limits.flags & Limit.POSITION) != 0, ranged != goal)
        last = out.position.copy()


def test_a_goal_that_jumps_arrives_all_the_same_and_a_glitch_is_cut_off():
    limits = JointLimits(ROBOT, 300)
    command = JointCommand.zeros(N)
    command.stiffness[:], command.position[:] = 10.0, 0.1
    limits.apply(command)
    command.position[3] = 1.5
    ticks = 0
    while limits.apply(command).position[3] != 1.5:
        ticks += 1
        assert limits.flags[3] == Limit.VELOCITY
    assert ticks == int(1.4 / STEP[3])
    command.position[3] = 0.1
    assert limits.apply(command).position[3] == pytest.approx(1.5 - STEP[3])


def test_a_command_that_is_refused_does_not_move_what_the_next_one_starts_from():
    limits = JointLimits(ROBOT, 300)
    command = JointCommand.zeros(N)
    command.stiffness[:], command.position[:] = 10.0, 0.1
    limits.apply(command)
    command.position[3], command.torque[0] = 2.0, np.nan
    with pytest.raises(InvalidCommandError):
        limits.apply(command)
    command.torque[0] = 0.0
    assert limits.apply(command).position[3] == pytest.approx(0.1 + STEP[3])


def test_flags_of_one_tick_are_gone_in_the_next():
    limits = JointLimits(ROBOT)
    command = JointCommand.zeros(N)
    command.position[:], command.stiffness[:] = 0.1, 1.0
    command.position[3] = 9.0
    limits.apply(command)
    assert limits.flags.tolist() == [0, 0, 0, int(Limit.POSITION)] + [0] * 8
    command.position[3] = 0.1
    limits.apply(command)
    assert not limits.flags.any()


def test_a_joint_that_only_takes_torque_has_no_position_to_limit():
    limits = JointLimits(ROBOT)
    limits.apply(JointCommand.zeros(N))  # the knee's range begins above 0
    assert not limits.flags.any()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("field", ["position", "velocity", "stiffness", "damping", "torque"])
def test_a_value_that_is_not_finite_is_refused_by_joint_and_field(field, bad):
    command = JointCommand.zeros(N)
    getattr(command, field)[4] = bad
    with pytest.raises(InvalidCommandError, match=f"{field} of left_ankle_pitch"):
        JointLimits(ROBOT).apply(command)
