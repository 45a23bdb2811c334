"""What is learnt from the way a pendulum falls."""

import math

import pytest

from controller.walking.place_trim import PlaceTrim, PlaceTrimConfig

OMEGA, DT = 6.8, 1 / 300
CONFIG = PlaceTrimConfig(gain=0.2, error_limit=0.01, bound=0.015, settle_time=0.06, delay=0.0)


def walk(trim, steps, error, push=0.0):
    """Let both feet carry pendulums that are seen `error[foot]` ahead of where they are."""
    for step in range(steps):
        foot = step % 2
        x, v = -0.03, 0.25
        for tick in range(60):
            cop = 0.01 * math.sin(tick / 10)
            trim.add(x + error[foot], v, cop, OMEGA)
            # Exact enough: the pendulum between two ticks with the mean acceleration.
            a = OMEGA**2 * (x - cop) + push
            x += DT * v + 0.5 * DT * DT * a
            v += DT * a
        trim.end_step(foot, DT)


def test_each_foot_learns_its_own_error():
    trim, errors = PlaceTrim(CONFIG), [0.004, -0.005]
    walk(trim, 60, errors)
    assert trim.value == pytest.approx(errors, abs=5e-4)


def test_one_pushed_step_teaches_little_and_no_error_exceeds_the_bound():
    trim = PlaceTrim(CONFIG)
    walk(trim, 2, [0.0, 0.0], push=2.0)
    assert max(abs(value) for value in trim.value) <= 0.2 * 0.01 + 1e-9
    walk(trim, 80, [0.05, 0.0])
    assert trim.value[0] == pytest.approx(0.015)


def test_a_step_without_single_support_teaches_nothing():
    trim = PlaceTrim(CONFIG)
    for _ in range(10):
        trim.add(0.05, 0.0, 0.0, OMEGA)
    trim.end_step(0, DT)
    assert trim.value[0] == 0.0
