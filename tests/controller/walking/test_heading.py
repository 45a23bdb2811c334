"""A turn: two ramps of 0.3 s, begun in time and by the inner foot."""

import math

import pytest

from controller.walking.gait import Gait, GaitConfig
from controller.walking.heading import HeadingConfig, HeadingRamp

GAIT = GaitConfig(period=0.7, min_phase=0.4, max_phase=1.0, touch_down_load=0.145)
DT = 0.001


def walk(ramp, turn_at, turn, seconds, stance=0):
    """Headings tick by tick of a gait that always steps at phase 1; the turn comes at a time."""
    gait = Gait(GAIT, weight=700.0, stance=stance)
    headings = []
    for k in range(round(seconds / DT)):
        gait.advance(DT, swing_load=0.0)
        headings.append(ramp.update(DT, gait, turn if k * DT >= turn_at else 0.0))
    return headings


def ramp_of(**changes):
    return HeadingRamp(HeadingConfig(ramp_time=0.3, start_phase=0.2, **changes))


def test_half_of_the_turn_in_each_of_two_ramps():
    headings = walk(ramp_of(), turn_at=0.0, turn=1.0, seconds=1.5)

    def at(seconds):
        return headings[round(seconds / DT)]

    assert at(0.13) == 0.0
    assert at(0.14 + 0.15) == pytest.approx(0.25, abs=0.01)
    assert at(0.45) == at(0.83) == pytest.approx(0.5, abs=1e-9)
    assert at(0.84 + 0.15) == pytest.approx(0.75, abs=0.01)
    assert at(1.2) == pytest.approx(1.0, abs=1e-9)


def test_command_after_the_start_phase_waits_for_the_next_step():
    headings = walk(ramp_of(), turn_at=0.3, turn=1.0, seconds=2.0)
    assert headings[round(0.8 / DT)] == 0.0
    assert headings[round(1.2 / DT)] == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize(("turn", "first_ramp"), [(1.0, 0.84), (-1.0, 0.14)])
def test_large_turn_begins_on_the_outer_stance_foot(turn, first_ramp):
    """On the left foot a right turn begins at once; a left one waits for the right foot."""
    ramp = ramp_of(inner_foot_above=0.6)
    headings = walk(ramp, turn_at=0.0, turn=turn, seconds=3.0)
    assert headings[round((first_ramp - 0.01) / DT)] == 0.0
    assert headings[round((first_ramp + 0.31) / DT)] == pytest.approx(turn / 2, abs=1e-9)
    assert headings[-1] == pytest.approx(turn, abs=1e-9)
    assert not ramp.turning


def test_small_turn_never_waits():
    headings = walk(ramp_of(inner_foot_above=0.6), turn_at=0.0, turn=0.5, seconds=1.0)
    assert headings[round(0.5 / DT)] == pytest.approx(0.25, abs=1e-9)


def test_turn_that_is_revised_on_its_way_ends_at_the_last_command():
    ramp = ramp_of()
    walk(ramp, turn_at=0.0, turn=math.pi / 2, seconds=0.9)
    assert walk(ramp, turn_at=0.0, turn=-0.2, seconds=3.0)[-1] == pytest.approx(-0.2, abs=1e-9)
