"""Pendulum foot placement against the pendulum's energy and by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.walking.foot_placement import (
    FootPlacement,
    FootPlacementConfig,
    pendulum_distance,
)

CONFIG = FootPlacementConfig(
    gain=(1.1, 1.1),
    speed_offset=(0.1, 0.18),
    half_width=0.05,
    limit=0.4,
    end_phase=0.9,
)


@given(st.floats(-2, 2), st.floats(0.1, 1.5))
def test_ideal_pendulum_just_comes_to_rest_upright(velocity, height):
    """½v² + gh = gL with the leg L = √(h² + d²): the energy that the placement is made of."""
    distance = pendulum_distance(velocity, height, gain=1.0, gravity=9.81)
    leg = math.hypot(height, distance)
    assert 0.5 * velocity**2 + 9.81 * height == pytest.approx(9.81 * leg, rel=1e-9)
    assert distance * velocity >= 0


def test_fallen_body_gives_a_number():
    assert math.isfinite(pendulum_distance(1.0, -0.5, 1.1, 9.81))


def test_distance_by_hand():
    placement = FootPlacement(CONFIG, leg_length=0.93, gravity=9.81)
    velocity, wanted = np.array([0.5, -0.1]), np.array([0.5, -0.2])
    d = placement.distance(velocity, 1.0, wanted, alteration=-0.06, outward=-0.05)
    # 1.1·0.5·√(0.101937 + 0.000649) = 0.17616; 1.1·(−0.1)·√(0.101937 + 0.000026) = −0.03512
    assert d[0] == pytest.approx(0.17616 - 0.05 - 0.06, abs=1e-5)
    assert d[1] == pytest.approx(-0.03512 + 0.036 - 0.05, abs=1e-5)


def test_distance_is_limited_to_a_part_of_the_leg():
    placement = FootPlacement(CONFIG, leg_length=0.93, gravity=9.81)
    d = placement.distance(np.array([3.0, -3.0]), 1.0, np.zeros(2), 0.0, 0.0)
    assert d == pytest.approx([0.372, -0.372])


def test_foot_is_led_from_the_take_over_to_the_end_phase():
    placement = FootPlacement(CONFIG, 0.93, 9.81)
    assert placement.share(0.5, None) == 0.0
    assert placement.share(0.1, 0.2) == 0.0
    assert placement.share(0.55, 0.2) == pytest.approx(0.75)
    assert placement.share(0.45, 0.0) == pytest.approx(0.75)
    assert placement.share(0.95, 0.2) == 1.0


def test_late_take_over_does_not_make_the_foot_jump():
    placement = FootPlacement(CONFIG, 0.93, 9.81)
    assert placement.share(0.9, 0.88) < 0.4
    assert placement.share(0.98, 0.88) == pytest.approx(1.0)


def test_the_lead_in_water_goes_with_level_speed_and_liquid():
    config = CONFIG.model_copy(update={"drag_lag": ((0.0, 0.0), (0.5, 0.4), (1.0, 0.2))})
    placement = FootPlacement(config, 0.93, 9.81)
    assert placement.lead(0.5, 0.5, 1.0) == pytest.approx(0.4 * 0.125)
    assert placement.lead(0.5, 0.25, 1.0) == pytest.approx(0.2 * 0.125)
    assert placement.lead(-0.5, 0.75, 1.5) == pytest.approx(-1.5 * 0.3 * 0.125)
    assert placement.lead(0.5, 0.0, 1.0) == 0.0
    assert FootPlacement(CONFIG, 0.93, 9.81).lead(0.7, 1.0, 1.0) == 0.0
