"""Each foot learns how far beside its goal it lands."""

import numpy as np
import pytest
from servo_bench import ServoBench, minibiped

from controller.walking.landing_trim import LandingTrim, LandingTrimConfig
from hil.interface import Reference

CONFIG = LandingTrimConfig(gain=0.2, error_limit=0.01, bound=0.02, min_phase=0.9)


def test_a_foot_that_is_sent_aside_by_its_trim_lands_where_it_should():
    trim, beside = LandingTrim(CONFIG), [0.008, -0.003]
    for step in range(80):
        foot = step % 2
        trim.land(foot, beside[foot] - trim.value[foot], 1.0)
    assert trim.value == pytest.approx(beside, abs=1e-5)


def test_a_foot_that_landed_early_or_was_pushed_aside_teaches_nothing_or_little():
    trim = LandingTrim(CONFIG)
    trim.land(0, 0.008, 0.85)
    trim.land(1, 0.08, 1.0)
    assert trim.value == [0.0, pytest.approx(0.002)]
    for _ in range(80):
        trim.land(1, 0.08, 1.0)
    assert trim.value[1] == pytest.approx(0.02)


def beside_its_goal(gain):
    """Mean distance of left and right landings in time from their goals, to the left [m]."""
    bench = ServoBench(minibiped([("landing_trim.gain", gain)]))
    step, ankles = bench.walker._step, bench.walker._model.ankles
    steps, phase, goal, errors = 0, 0.0, 0.0, [[], []]
    for tick in range(7 * 300):
        bench.run(Reference(speed=0.1))
        if step.gait.steps > steps and tick > 4 * 300 and phase > 0.9:
            foot = step.gait.stance
            errors[foot].append(float(ankles[foot][1] - ankles[1 - foot][1]) - goal)
        steps, phase, goal = step.gait.steps, step.gait.phase, step._goal[1]
    return np.array([np.mean(error) for error in errors])


def test_a_walking_robots_feet_land_beside_their_goals_unless_it_learns():
    untaught, taught = np.abs(beside_its_goal(0.0)), np.abs(beside_its_goal(0.2))
    assert untaught.min() > 0.0035
    assert taught.max() < 0.5 * untaught.min()
