"""Learning the speed deviation within a step."""

import numpy as np
import pytest

from controller.walking.learned_velocity import LearnedVelocity
from controller.walking.torque_config import LearnedVelocityConfig

CONFIG = LearnedVelocityConfig(knots=11, threshold=0.6, rate=0.5, normalise="mean")
PHASES = np.linspace(0.0, 1.0, 201)


def teach(learned, steps, speed, stance=0, learn=True, wanted=0.5):
    for _ in range(steps):
        for phase in PHASES:
            learned.observe(phase, speed(phase))
        learned.end_step(stance, learn, wanted)


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
    learned.end_step(0, learn=True, wanted=0.5)
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


def test_a_scaled_curve_belongs_to_the_speed_that_is_wanted():
    """A step at 0.5 m/s where 0.4 is wanted: its waves count as much smaller as the speed is."""
    learned = LearnedVelocity(CONFIG.model_copy(update={"sagittal": "scaled"}), capacity=300)
    teach(learned, 25, wave, wanted=0.4)
    assert learned.deviation(0, 0.0)[0] == pytest.approx(0.08, abs=0.005)
    assert learned.deviation(0, 0.25)[1] == pytest.approx(0.05, abs=0.005), "coronal: shifted"


def test_a_scaled_curve_follows_a_new_speed_at_once():
    learned = LearnedVelocity(CONFIG.model_copy(update={"sagittal": "scaled"}), capacity=300)
    teach(learned, 25, wave)
    teach(learned, 1, lambda phase: 1.6 * wave(phase), wanted=0.8)
    assert learned.deviation(0, 0.0)[0] == pytest.approx(0.16, abs=0.01)


def test_slow_walks_are_not_scaled():
    learned = LearnedVelocity(CONFIG.model_copy(update={"sagittal": "scaled"}), capacity=300)
    teach(learned, 25, lambda phase: wave(phase) - [0.49, 0.0], wanted=0.02)
    assert learned.deviation(0, 0.0)[0] == pytest.approx(0.1, abs=0.01)
