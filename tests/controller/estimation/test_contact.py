"""Contact from noisy corner forces."""

import numpy as np
import pytest

from controller.estimation.config import ContactConfig
from controller.estimation.contact import ContactDetector

WEIGHT, DT = 25.7, 1 / 300


def detector(**settings):
    return ContactDetector(ContactConfig(**settings), WEIGHT, DT)


def feed(contact, load, ticks, noise=0.0, seed=0):
    """Feed the left foot a load; every flag that was seen."""
    rng = np.random.default_rng(seed)
    seen = []
    for _ in range(ticks):
        force = np.zeros((2, 4))
        force[0] = load / 4
        contact.update(force + rng.normal(0.0, noise, (2, 4)))
        seen.append(contact.contact.copy())
    return np.array(seen)


@pytest.mark.parametrize("seed", range(5))
def test_two_newtons_of_noise_a_cell_switch_nothing(seed):
    contact = detector()
    assert not feed(contact, 0.0, 600, noise=2.0, seed=seed).any()
    feed(contact, WEIGHT, 30)
    assert feed(contact, WEIGHT, 600, noise=2.0, seed=seed)[:, 0].all()


def test_a_load_between_the_thresholds_keeps_the_flag():
    contact = detector()
    assert not feed(contact, 0.2 * WEIGHT, 100)[:, 0].any()
    feed(contact, WEIGHT, 100)
    assert feed(contact, 0.2 * WEIGHT, 100)[:, 0].all()
    assert not feed(contact, 0.0, 100)[-1, 0]


def test_touch_down_is_felt_within_two_filter_times():
    contact = detector()
    seen = feed(contact, WEIGHT, 10)[:, 0]
    assert seen[: round(2 * 0.010 / DT)].any()
    assert not contact.contact[1]


def test_without_filter_the_forces_pass_unchanged():
    contact = detector(filter_time=0.0)
    force = np.arange(8.0).reshape(2, 4)
    contact.update(force)
    np.testing.assert_array_equal(contact.force, force)
