"""Walks in water, and what each mechanism of it is worth."""

import pytest

from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Schedules
from hil.studies.foot_lift import foot_lift
from hil.studies.walks import mean_velocity, walk


def wade(*overrides, robot="human", seconds=9.0, speed=0.5, **liquid):
    schedules = Schedules(speed=((0.0, speed),), **liquid)
    request = RunRequest(robot=robot, duration_s=seconds, schedules=schedules, overrides=overrides)
    return walk(request)


def test_the_human_wades_through_knee_deep_water_at_the_commanded_speed():
    walked = wade(water=((0.0, 0.5),))
    assert walked.stopped_s is None
    assert mean_velocity(walked.trace)[0] == pytest.approx(0.5, rel=0.02)


def test_without_leading_the_foot_through_the_water_it_falls_forward():
    """`placement.drag_lag`: with it 9 s and 0.50 m/s, without it a fall at 2.5 s."""
    walked = wade("walking.placement.drag_lag=[]", water=((0.0, 0.5),), seconds=5.0)
    assert walked.ending == "fell"
    assert walked.stopped_s < 4.0


def test_at_0_7_mps_the_foot_leaves_the_water_and_without_that_style_the_walk_falls():
    """The combiner: 0.7 m/s with the foot lifted above the level of 0.5 m less the shank."""
    walked = wade(water=((0.0, 0.5),), speed=0.7)
    assert walked.stopped_s is None
    assert mean_velocity(walked.trace)[0] == pytest.approx(0.7, rel=0.03)
    human = load_robot("human")
    assert foot_lift(human, walked.trace) > 0.3
    alone = wade("walking.styles=[]", water=((0.0, 0.5),), speed=0.7, seconds=7.0)
    assert alone.ending == "fell"


def test_water_that_rises_and_falls_during_a_walk():
    walked = wade(water=((0.0, 0.0), (5.0, 0.75), (10.0, 0.0)), seconds=12.0)
    assert walked.stopped_s is None


def test_the_small_biped_wades_in_the_dry_run():
    """5 cm on a leg of 0.22 m: knee-deep on the human is 0.5 m."""
    walked = wade(robot="minibiped", speed=0.1, seconds=4.0, water=((0.0, 0.05),))
    assert walked.stopped_s is None
    assert walked.report["steps"] >= 5
