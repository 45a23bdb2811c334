"""Recovery steps: when they begin, what ends them, when the learned curve is forgotten."""

from controller.walking.recovery import Recovery, RecoveryConfig

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
