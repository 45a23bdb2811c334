"""Simple controllers at work: backward with the toes first, and in place with the knees up."""

import numpy as np
import pytest

from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Schedules
from hil.studies.foot_lift import foot_lift
from hil.studies.walks import mean_velocity, walk

STANDARD = "walking.styles=[]"


def stepped(speed, *overrides):
    schedules = Schedules(speed=((0.0, speed),))
    request = RunRequest(robot="human", duration_s=7.0, schedules=schedules, overrides=overrides)
    walked = walk(request)
    assert walked.stopped_s is None
    return walked.trace


def toes_first(trace):
    """Share of the swing foot's first contacts, from 2 s on, that are with its fore part."""
    fore = trace.foot_force[:, :, :2].sum(axis=2) + trace.toe_force
    load = trace.foot_force[:, :, 2:].sum(axis=2) + fore
    first = []
    for foot in (0, 1):
        air = load[:, foot] < 1.0
        landed = np.flatnonzero(air[:-1] & ~air[1:]) + 1
        before = landed - 1  # the step may end with this very contact
        swings = (trace.stance[before] != foot) & (trace.phase[before] > 0.25)
        late = trace.time_s[landed] > 2.0
        for tick in landed[swings & late]:
            first.append(fore[tick, foot] > 0.5 * load[tick, foot])
    assert len(first) >= 6
    return np.mean(first)


def test_backward_the_toes_touch_first_and_with_the_standard_controller_the_heel():
    backward = stepped(-0.3)
    assert mean_velocity(backward)[0] == pytest.approx(-0.3, abs=0.01)
    assert toes_first(backward) > 0.9
    assert toes_first(stepped(-0.3, STANDARD)) < 0.1


def test_in_place_the_feet_are_lifted_higher_without_moving_on():
    human = load_robot("human")
    in_place = stepped(0.0)
    assert mean_velocity(in_place)[0] == pytest.approx(0.0, abs=0.02)
    assert foot_lift(human, in_place) > 0.18
    assert foot_lift(human, stepped(0.0, STANDARD)) < 0.15
