"""Figures of single walks: phases, velocities, turns, schedules, robot facts."""

import math

import numpy as np
import pytest
from hil_walks import walk as made_up_walk

from controller.robot_model import RobotModel
from hil.errors import InputError, UnknownNameError
from hil.request import RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.schedule import Operator, Schedules
from hil.studies.coronal_cycle import coronal_cycle
from hil.studies.pushes import DIRECTIONS, check_directions, ladder
from hil.studies.turns import TurnCase, turn_figures, turn_points
from hil.studies.walks import mean_step_time, mean_velocity, step_starts


@pytest.mark.parametrize("robot", ["human", "minibiped"])
def test_mass_and_leg_are_those_of_the_controllers_model(robot):
    description = load_robot(robot)
    facts, model = robot_facts(description), RobotModel(description)
    assert facts.mass == pytest.approx(model.mass)
    assert facts.leg_length == pytest.approx(model.leg_length)
    assert facts.weight == pytest.approx(model.weight)
    assert facts.speed_scale * facts.time_scale == pytest.approx(model.leg_length)


def test_steps_are_found_where_the_count_rises():
    times, stance = step_starts(made_up_walk(10.0))
    np.testing.assert_allclose(times, np.arange(0.5, 10.0, 0.5))
    assert stance[0] == 1 and stance[1] == 0
    assert mean_step_time(made_up_walk(10.0)) == pytest.approx(0.5)


def test_velocity_is_along_the_heading_and_free_of_sway():
    trace = made_up_walk(20.0)
    sway = 0.05 * np.cos(2 * np.pi * trace.time_s + 0.7)  # once a stride of 1 s
    forward, left = 0.2 * trace.time_s, 0.04 * trace.time_s + sway
    heading = 0.8
    x = forward * math.cos(heading) - left * math.sin(heading)
    y = forward * math.sin(heading) + left * math.cos(heading)
    com = np.column_stack((x, y, np.full(len(x), 0.2)))
    turned = made_up_walk(20.0, com=com, heading=np.full(len(x), heading))
    assert mean_velocity(turned) == pytest.approx((0.2, 0.04), abs=1e-9)


def test_a_walk_without_strides_has_no_velocity():
    assert all(math.isnan(speed) for speed in mean_velocity(made_up_walk(1.0)))


def turned_walk(angle, overshoot):
    """A yaw that rises linearly in the second from 5 s, then holds more than the angle."""
    trace = made_up_walk(12.0)
    share = np.clip(trace.time_s - 5.0, 0.0, 1.0) * (1 + overshoot)
    share[trace.time_s > 9.0] = 1.01
    yaw = 0.1 + angle * share
    half = np.column_stack((np.cos(yaw / 2), 0 * yaw, 0 * yaw, np.sin(yaw / 2)))
    return made_up_walk(12.0, base_orientation=half)


@pytest.mark.parametrize("degrees", [115.0, -90.0, 170.0])
def test_turn_figures(degrees):
    angle = math.radians(degrees)
    found = turn_figures(turned_walk(angle, 0.1), angle, 5.0)
    assert found["time_to_95_s"] == pytest.approx(0.95 / 1.1, abs=0.011)
    assert found["overshoot_pct"] == pytest.approx(10.0, abs=0.01)
    assert found["final_error_deg"] == pytest.approx(0.01 * degrees, abs=0.01)


def test_a_turn_that_is_not_made_is_not_reached():
    found = turn_figures(made_up_walk(12.0), 1.0, 5.0)
    assert found["time_to_95_s"] is None
    assert found["final_error_deg"] == pytest.approx(-math.degrees(1.0))


@pytest.mark.parametrize(("rate", "end_s"), [(0.0, 5.0), (1.0, 7.0)])
def test_turn_points_add_up_at_the_asked_rate(rate, end_s):
    case = TurnCase(
        request=RunRequest(),
        angle_deg=-math.degrees(2.0),
        turn_rate=rate,
        start_s=5.0,
        duration_s=9.0,
    )
    operator = Operator(Schedules(turns=turn_points(case)), 0.1)
    assert operator.reference(4.99).heading == 0.0
    assert operator.reference(end_s + 0.001).heading == pytest.approx(-2.0)
    middle = operator.reference((5.0 + end_s) / 2).heading
    assert middle == pytest.approx(-2.0 if rate == 0.0 else -1.0, abs=0.03)


def test_the_coronal_cycle_jumps_every_five_steps():
    operator = Operator(Schedules(lateral=coronal_cycle(0.2, 0.48, 30.0)), 0.5)
    assert [operator.reference(2.4 * leg + 0.001).lateral for leg in range(6)] == [
        0.0, 0.2, -0.2, 0.0, 0.2, -0.2
    ]  # fmt: skip
    assert operator.reference(2.399).lateral == 0.0


def test_directions_are_unit_vectors_and_unknown_ones_are_named():
    for x, y in DIRECTIONS.values():
        assert math.hypot(x, y) == pytest.approx(1.0)
    with pytest.raises(UnknownNameError, match="back_left"):
        check_directions(["up"])


def test_the_ladder_of_forces():
    human = RunRequest(robot="human")
    assert ladder(human, 50.0, 300.0, 0.3) == (50, 100, 150, 200, 250, 300)
    assert ladder(human, None, None, 0.3) == (50, 100, 150, 200, 250, 300)
    small = ladder(RunRequest(), None, None, 0.3)
    facts = robot_facts(load_robot("minibiped"))
    assert small[-1] * 0.3 / facts.mass / facts.speed_scale == pytest.approx(0.42, abs=0.05)
    with pytest.raises(InputError, match="--force-step"):
        ladder(human, 200.0, 100.0, 0.3)
