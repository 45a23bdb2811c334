"""Motion profiles: they take the time that the e-manual's formulas give, and overshoot nothing."""

import numpy as np
import pytest

from sim_backends.motion_profile import ACCELERATION_UNIT, VELOCITY_UNIT, MotionProfile

DT = 1 / 1200


def travel(profile, goal, longest=10.0):
    """Positions until the goal is reached."""
    profile.aim(goal)
    track = [profile.position]
    while profile.position != goal and len(track) * DT < longest:
        profile.advance()
        track.append(profile.position)
    return np.array(track)


def made(velocity, acceleration, time_based=False):
    profile = MotionProfile(DT)
    profile.restart(2048.0)
    profile.configure(velocity, acceleration, time_based)
    return profile


def test_units_are_those_of_the_e_manual():
    """0.229 rev/min and 214.577 rev/min², of 4096 counts a turn."""
    assert pytest.approx(15.633, abs=1e-3) == VELOCITY_UNIT
    assert pytest.approx(244.14, abs=1e-2) == ACCELERATION_UNIT


def test_velocity_zero_is_a_step():
    assert len(travel(made(0, 20), 3000.0)) == 2


def test_a_rectangle_takes_distance_over_velocity():
    track = travel(made(100, 0), 3048.0)
    assert len(track) * DT == pytest.approx(1000 / (100 * VELOCITY_UNIT), abs=3 * DT)


@pytest.mark.parametrize("goal", [3648.0, 448.0])
def test_a_trapezoid_takes_its_time_at_its_velocity(goal):
    velocity, acceleration = 100 * VELOCITY_UNIT, 20 * ACCELERATION_UNIT
    track = travel(made(100, 20), goal)
    expected = 1600 / velocity + velocity / acceleration
    assert len(track) * DT == pytest.approx(expected, abs=0.01)
    speeds = np.abs(np.diff(track)) / DT
    assert speeds.max() == pytest.approx(velocity, rel=1e-6)
    assert np.abs(np.diff(speeds[:-1])).max() / DT <= acceleration * 1.01
    assert np.abs(track - 2048).max() <= abs(goal - 2048) + 1e-9


def test_a_short_way_is_a_triangle():
    track = travel(made(300, 20), 2148.0)
    assert len(track) * DT == pytest.approx(2 * np.sqrt(100 / (20 * ACCELERATION_UNIT)), abs=0.01)


@pytest.mark.parametrize(("total", "ramp"), [(800, 200), (500, 0), (600, 500)])
@pytest.mark.parametrize("goal", [3048.0, 2100.0])
def test_a_time_based_profile_takes_that_time_for_any_distance(total, ramp, goal):
    track = travel(made(total, ramp, time_based=True), goal)
    assert len(track) * DT == pytest.approx(1e-3 * total, abs=0.01)


def test_a_new_goal_on_the_way_is_reached_without_a_jump():
    profile = made(100, 20)
    profile.aim(4000.0)
    for _ in range(400):
        profile.advance()
    before = profile.velocity
    track = travel(profile, 1500.0)
    steps = np.diff(track) / DT
    assert steps[0] == pytest.approx(before, abs=20 * ACCELERATION_UNIT * DT * 1.01)
    assert track[-1] == 1500.0
    assert track.min() >= 1500.0 - 1e-9
