"""Equation 4, term by term."""

import numpy as np
import pytest

from controller.search.gain_objective import (
    f_balance,
    f_gains,
    f_motion,
    f_outside,
    f_speed,
    speed_tolerance,
)


def test_small_gains_are_cheap_for_the_smallest_and_dear_for_the_largest():
    start = [100.0, 10.0, 0.0]
    assert f_gains(start, start, largest=False) == 64.0
    assert f_gains([50.0, 5.0, 9.0], start, largest=False) == 32.0
    assert f_gains(start, start, largest=True) == pytest.approx(64.0 * 2 / 3)
    assert f_gains([300.0, 30.0, 0.0], start, largest=True) == pytest.approx(0.0)


def test_a_joint_counts_by_its_ratio_and_not_by_its_size():
    start = [1000.0, 10.0]
    assert f_gains([1100.0, 10.0], start, False) == pytest.approx(
        f_gains([1000.0, 11.0], start, False)
    )


def test_a_place_outside_its_band_costs_by_the_square_up_to_a_unit():
    inside = np.array([1.66, 1.68, 1.695])
    assert f_outside(inside, (1.66, 1.695), 0.01) == 0.0
    half_a_unit = np.array([1.68, 1.655, 1.68, 1.70])
    assert f_outside(half_a_unit, (1.66, 1.695), 0.01) == pytest.approx(1e8 * (0.25 + 0.25) / 4)
    far = np.array([0.3, 1.68])
    assert f_outside(far, (1.66, 1.695), 0.01) == pytest.approx(1e8 / 2)


def test_the_mean_over_ticks_does_not_depend_on_the_rate():
    slow = np.array([0.03, 0.06])
    assert f_outside(np.repeat(slow, 5), (0, 0.04), 0.02) == pytest.approx(
        f_outside(slow, (0, 0.04), 0.02)
    )


def test_both_hands_count_and_lengths_scale_with_the_leg():
    motion = {"hands": np.array([[0.05, 0.05]]), "head_pitch": np.array([0.005])}
    bands = {"hands": (0.0, 0.04), "head_pitch": (-0.01, 0.0)}
    assert f_motion(motion, bands, 1.0) == pytest.approx(1e8 * (1.0 + 1.0 + 0.25))
    assert f_motion(motion, bands, 2.0) == pytest.approx(1e8 * (0.25 + 0.25 + 0.25))


def test_a_speed_may_be_wrong_by_a_twentieth_and_at_least_by_2_cm_per_s():
    assert speed_tolerance(0.7, 1.0) == pytest.approx(0.035)
    assert speed_tolerance(0.1, 1.0) == pytest.approx(0.02)
    assert speed_tolerance(0.0, 0.25) == pytest.approx(0.01)
    assert f_speed(0.534, 0.5, 0.035) == 0.0
    assert f_speed(0.5 - 0.035 * 1.5, 0.5, 0.035) == pytest.approx(1e10 / 16)
    assert f_speed(-1.0, 0.5, 0.035) == 1e10


def test_a_fall_outweighs_everything_and_an_early_one_more():
    assert f_balance(10.0, 10.0) == 0.0
    assert 1e19 < f_balance(9.0, 10.0) < f_balance(1.0, 10.0) < 2e19
