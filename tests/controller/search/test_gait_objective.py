"""Terms of the gait search on motions whose cost is known."""

import numpy as np
import pytest

from controller.search import gait_objective as objective

RATE = 100.0


def motion(torque=1.0, position=None, alteration=0.0, drag=0.0, reference=None):
    time = np.arange(200) / RATE
    position = np.zeros_like(time) if position is None else position(time)
    return objective.GaitMotion(
        RATE,
        np.tile([torque, -torque], (len(time), 1)),
        np.column_stack((position, position)),
        np.full(len(time), alteration),
        np.full(len(time), drag),
        leg_scale=1.0,
        reference=reference,
    )


def test_torques_of_opposite_sign_do_not_cancel():
    assert objective.f_energy(motion(torque=2.0)) == pytest.approx(4.0)


def test_acceleration_is_that_of_the_motion():
    assert objective.f_acceleration(motion(position=lambda t: 1.5 * t**2)) == pytest.approx(18.0)
    assert objective.f_acceleration(motion(position=lambda t: 3.0 * t)) == pytest.approx(
        0.0, abs=1e-9
    )


def test_three_quarters_of_the_acceleration_are_the_motion_s():
    moved = motion(position=lambda t: 1.5 * t**2, reference=10.0)
    assert objective.f_acceleration(moved) == pytest.approx(0.75 * 18.0 + 0.25 * 10.0)


def test_drag_is_judged_by_its_mean_torque():
    assert objective.f_drag(motion(drag=2.5)) == pytest.approx(2.5)


def test_the_start_costs_the_sum_of_the_weights():
    terms = objective.terms_of(motion(position=np.sin))
    assert objective.f_sum(terms, terms, objective.WEIGHTINGS["3-6-1"]) == pytest.approx(4.0)
    terms = objective.terms_of(motion(position=np.sin, drag=2.0))
    assert objective.f_sum(terms, terms, objective.WEIGHTINGS["3-6-1"]) == pytest.approx(10.0)
    half = {name: 0.5 * value for name, value in terms.items()}
    assert objective.f_sum(half, terms, {"energy": 3.0}) == pytest.approx(1.5)


def test_relying_on_the_alteration_costs_a_tenth():
    assert objective.alteration_factor(motion()) == 1.0
    assert objective.alteration_factor(motion(alteration=-0.09)) == pytest.approx(1.1)


def test_speed_counts_beyond_its_tolerance():
    assert objective.f_speed(0.004, 0.005) == 0.0
    assert 0.0 < objective.f_speed(-0.006, 0.005) < objective.f_speed(0.009, 0.005) < 1e10
    assert objective.f_speed(0.5, 0.005) == 1e10


def test_recovery_steps_cost_more_than_any_speed_error():
    assert objective.f_recovery(0.0) == 0.0
    assert objective.f_recovery(0.1) > objective.f_speed(1.0, 0.005)


def test_a_fall_costs_more_than_anything_and_the_earlier_the_more():
    assert objective.f_balance(1.0, pushed=False) == 0.0
    assert objective.f_balance(0.3, pushed=False) > objective.f_balance(0.9, pushed=False) > 1e15
    assert objective.f_balance(0.75, pushed=True) == pytest.approx(25.0)
