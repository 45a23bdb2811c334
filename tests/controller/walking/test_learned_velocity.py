"""Learning the speed deviation within a step."""

import numpy as np
import pytest

from controller.walking.learned_velocity import LearnedVelocity
from controller.walking.torque_config import LearnedVelocityConfig

CONFIG = LearnedVelocityConfig(knots=11, threshold=0.6, rate=0.5, normalise="mean")
PHASES = np.linspace(0.0, 1.0, 201)


def teach(learned, steps, speed, stance=0, learn=True):
    for _ in range(steps):
        for phase in PHASES:
            learned.observe(phase, speed(phase))
        learned.end_step(stance, learn)


def wave(phase):
    return np.array([0.5 + 0.1 * np.cos(2 * np.pi * phase), 0.05 * np.sin(2 * np.pi * phase)])


def test_learns_the_deviation_from_the_mean_and_not_the_mean():
    learned = LearnedVelocity(CONFIG, capacity=300)
    teach(learned, 25, wave)
    for phase in (0.0, 0.25, 0.4, 0.8):
        expected = wave(phase) - [0.5, 0.0]
        assert learned.deviation(0, phase) == pytest.approx(expected, abs=0.01)
    assert learned.deviation(1, 0.0) == pytest.approx([0.0, 0.0])


def test_one_step_moves_at_most_half_the_mean_error():
    learned = LearnedVelocity(CONFIG, capacity=300)
    teach(learned, 1, wave)
    at = np.linspace(0, 1, 11)
    error = np.abs(0.1 * np.cos(2 * np.pi * at))
    assert np.abs(learned.values[0, 0]).max() == pytest.approx(0.5 * error.mean(), rel=0.02)


def test_disturbed_step_teaches_nothing():
    learned = LearnedVelocity(CONFIG, capacity=300)
    teach(learned, 1, lambda phase: np.array([3.0 * np.sign(phase - 0.5), 0.0]))
    assert not learned.values.any()


def test_frozen_step_teaches_nothing_and_is_forgotten():
    learned = LearnedVelocity(CONFIG, capacity=300)
    teach(learned, 1, wave, learn=False)
    assert not learned.values.any()
    learned.end_step(0, learn=True)
    assert not learned.values.any()


def test_longer_step_than_expected_is_no_error():
    learned = LearnedVelocity(CONFIG, capacity=50)
    teach(learned, 2, wave)
    assert np.isfinite(learned.values).all()


def test_median_of_the_curve_stays_zero_where_the_seed_normalises():
    """A short peak moves the mean of the step's speed, not its median."""
    learned = LearnedVelocity(CONFIG.model_copy(update={"normalise": "median"}), capacity=300)
    teach(learned, 25, lambda phase: np.array([0.5 + 0.3 * (phase > 0.75), 0.0]))
    assert learned.deviation(0, 0.3)[0] == pytest.approx(0.0, abs=0.01)
    assert learned.deviation(0, 0.9)[0] == pytest.approx(0.3, abs=0.03)


def test_reset_returns_to_the_constant_speed():
    learned = LearnedVelocity(CONFIG, capacity=300)
    teach(learned, 3, wave)
    learned.reset()
    assert learned.deviation(0, 0.25) == (0.0, 0.0)
