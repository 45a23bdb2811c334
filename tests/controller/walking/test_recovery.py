"""Recovery steps: when they begin, what ends them, when the learned curve is forgotten."""

import pytest

from controller.walking.recovery import AdaptiveThreshold, Recovery, RecoveryConfig

CONFIG = RecoveryConfig(threshold=0.35, reset_after=5)


def step(recovery, velocity, learned, desired=(0.5, 0.0), turning=False):
    for _ in range(10):
        recovery.observe(velocity, learned, desired)
    return recovery.end_step(turning)


def test_deviation_from_the_learned_speed_begins_a_recovery_on_either_axis():
    recovery = Recovery(CONFIG)
    assert not step(recovery, (0.8, 0.2), (0.5, 0.0))
    assert not recovery.active
    step(recovery, (0.5, -0.4), (0.5, 0.0))
    assert recovery.active
    assert recovery.steps == 1


def test_recovery_ends_against_the_desired_speed_not_the_learned_one():
    recovery = Recovery(CONFIG)
    step(recovery, (1.0, 0.0), (0.5, 0.0))
    step(recovery, (1.0, 0.0), (1.0, 0.0))
    assert recovery.active
    step(recovery, (0.6, 0.0), (1.2, 0.0))
    assert not recovery.active
    assert recovery.steps == 0


def test_more_than_five_recovery_steps_forget_the_curve_once():
    recovery = Recovery(CONFIG)
    resets = [step(recovery, (1.0, 0.0), (0.5, 0.0)) for _ in range(8)]
    assert resets == [False] * 5 + [True] + [False] * 2


def test_turn_is_no_disturbance():
    recovery = Recovery(CONFIG)
    step(recovery, (1.0, 0.5), (0.5, 0.0), turning=True)
    assert not recovery.active


def test_learning_starts_again_with_the_curve_forgotten():
    recovery = Recovery(CONFIG)
    frozen = []
    for _ in range(8):
        step(recovery, (1.0, 0.0), (0.5, 0.0))
        frozen.append(recovery.frozen)
    assert recovery.active
    assert frozen == [True] * 5 + [False] * 3


def test_an_adaptive_threshold_tightens_once_the_curve_has_converged():
    adaptive = AdaptiveThreshold(factor=3.0, least=0.1, converged=0.2, memory=0.5)
    recovery = Recovery(CONFIG.model_copy(update={"adaptive": adaptive}))
    step(recovery, (0.8, 0.0), (0.5, 0.0))  # 0.3: still learning
    step(recovery, (0.6, 0.0), (0.5, 0.0))
    assert recovery.threshold == 0.35
    step(recovery, (0.59, 0.0), (0.5, 0.0))  # converged at 0.09
    assert recovery.threshold == pytest.approx(0.27)
    step(recovery, (0.8, 0.0), (0.5, 0.0))
    assert recovery.active, "0.3 is a disturbance now, and was none before"
    step(recovery, (0.5, 0.0), (0.5, 0.0))
    assert not recovery.active
    assert recovery.threshold == 0.35, "a recovery begins anew"
    for _ in range(4):
        step(recovery, (0.51, 0.0), (0.5, 0.0))
    assert recovery.threshold == pytest.approx(0.1), "never below the least"
