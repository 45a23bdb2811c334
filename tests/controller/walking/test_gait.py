"""The gait state machine: what ends a step, and what is latched within it."""

import pytest

from controller.walking.gait import Gait, GaitConfig

CONFIG = GaitConfig(period=0.5, min_phase=0.4, max_phase=1.05, touch_down_load=0.1)
DT = 0.01
"""A fiftieth of a step."""


def gait():
    return Gait(CONFIG, weight=700.0)


def test_early_contact_does_not_end_the_step():
    walk = gait()
    assert not any(walk.advance(DT, swing_load=500.0) for _ in range(19))
    walk.advance(DT, swing_load=0.0)
    assert walk.advance(DT, swing_load=500.0)
    assert (walk.stance, walk.swing, walk.steps, walk.stance_sign) == (1, 0, 1, -1)
    assert walk.phase == walk.time_in_step == 0.0


def test_light_touch_does_not_end_the_step():
    walk = gait()
    ended = [walk.advance(DT, swing_load=69.0) for _ in range(50)]
    assert not any(ended)
    assert walk.advance(DT, swing_load=71.0)


def test_step_without_touch_down_ends_at_the_last_phase():
    walk = gait()
    ticks = next(k for k in range(1, 100) if walk.advance(DT, swing_load=0.0))
    assert ticks * DT / CONFIG.period == pytest.approx(1.05, abs=0.03)


def test_flat_foot_is_latched_until_the_next_step():
    walk = gait()
    walk.update_foot_flat(2)
    assert not walk.foot_flat
    walk.update_foot_flat(3)
    walk.update_foot_flat(1)
    assert walk.foot_flat
    for _ in range(60):
        walk.advance(DT, swing_load=0.0)
    assert walk.steps == 1
    assert not walk.foot_flat


def test_noise_of_one_tick_does_not_make_a_foot_flat():
    walk = Gait(CONFIG.model_copy(update={"flat_time": 2 * DT}), weight=700.0)
    found = []
    for corners in (3, 2, 3, 3, 2, 3, 3, 3):
        walk.advance(DT, swing_load=0.0)
        walk.update_foot_flat(corners)
        found.append(walk.foot_flat)
    assert found == [False] * 7 + [True]
