"""Gains of a robot as variables of a search, and back."""

import pytest

from controller.search.gain_space import blended, gains_at, scaled, variable_names, with_gains
from hil.robot_files import load_robot


@pytest.fixture(scope="module")
def human():
    return load_robot("human")


def test_a_robot_walks_with_the_gains_it_is_given_at_any_law_and_rate(human):
    gains = scaled(gains_at(human, 300, implicit=False), ["knee"], (0.5, 2.0))
    assert gains["knee"] == (150.0, 40.0)
    assert gains["hip"] == (300.0, 30.0)
    for rate_hz in (1000, 225, 60):
        for implicit in (False, True):
            changed = with_gains(human, rate_hz, gains)
            assert gains_at(changed, rate_hz, implicit) == gains


def test_the_robots_own_sets_stay_as_they_were(human):
    before = gains_at(human, 225, implicit=False)
    with_gains(human, 225, scaled(before, list(before), [2.0] * 2 * len(before)))
    assert gains_at(human, 225, implicit=False) == before


def test_servos_are_asked_for_the_gains_of_their_kind_of_joint():
    biped = load_robot("minibiped")
    gains = gains_at(biped, 300, implicit=False)
    changed = with_gains(biped, 300, scaled(gains, ["knee"], (0.5, 1.0)))
    asked = {joint.name: joint.stiffness for joint in changed.joints}
    usual = {joint.name: joint.stiffness for joint in biped.joints}
    assert asked["left_knee"] == asked["right_knee"] == usual["left_knee"] / 2
    assert asked["left_hip_yaw"] == usual["left_hip_yaw"]


def test_variables_have_the_names_of_their_gains():
    assert variable_names(["hip", "knee"]) == ("hip.kp", "hip.kd", "knee.kp", "knee.kd")


def test_the_next_rate_starts_from_a_blend():
    first, second = {"knee": (100.0, 10.0)}, {"knee": (200.0, 30.0)}
    assert blended(first, second, 0.2) == {"knee": pytest.approx((120.0, 14.0))}
