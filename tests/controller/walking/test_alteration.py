"""The step-end integral: sign, bounds, and that it ends at no error."""

import pytest

from controller.walking.alteration import Alteration, AlterationConfig
from controller.walking.step_average import StepAverage

from .conftest import HumanWalk

CONFIG = AlterationConfig(gain=0.1, error_limit=0.3, bounds=(-0.12, 0.05), start=-0.06)


def test_one_step_by_hand():
    alteration = Alteration(CONFIG)
    alteration.end_step(mean_speed=0.4, wanted_speed=0.5)
    assert alteration.value == pytest.approx(-0.06 - 0.1 * 0.1)


def test_large_error_counts_as_the_limit():
    alteration = Alteration(CONFIG)
    alteration.end_step(mean_speed=5.0, wanted_speed=0.5)
    assert alteration.value == pytest.approx(-0.06 + 0.1 * 0.3)


def test_stays_within_its_bounds():
    alteration = Alteration(CONFIG)
    for _ in range(10):
        alteration.end_step(0.0, 0.5)
    assert alteration.value == -0.12
    for _ in range(20):
        alteration.end_step(1.0, 0.5)
    assert alteration.value == 0.05


def test_removes_the_error_of_a_body_that_walks_faster_on_shorter_steps():
    alteration = Alteration(CONFIG)
    for _ in range(80):
        alteration.end_step(mean_speed=0.3 - 3.0 * alteration.value, wanted_speed=0.5)
    assert 0.3 - 3.0 * alteration.value == pytest.approx(0.5, abs=1e-3)


def test_step_average_starts_afresh():
    average = StepAverage()
    assert average.finish() == 0.0
    average.add(1.0)
    average.add(2.0)
    assert average.finish() == 1.5
    average.add(4.0)
    assert average.finish() == 4.0


def test_a_walk_tells_its_alteration():
    walk = HumanWalk()
    walk.tick()
    start = walk.description.walking["alteration"]["start"]
    assert walk.walker.status.alteration == start
    walk.walk(2.0)
    assert walk.walker.status.alteration != start
