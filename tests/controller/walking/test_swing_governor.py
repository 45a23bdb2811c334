"""The swing leg's targets stay within what servos can do, and the foot stays level on its way."""

import numpy as np
import pytest

from controller.walking.swing_governor import GovernorConfig, SwingGovernor

DT = 1 / 300
INERTIA, DAMPING, STALL = [0.04] * 6, [0.851] * 6, [4.1] * 6
HIP, KNEE, ANKLE = 2, 3, 4


def governed(wanted, share=0.8, level=0.5, more=0.0):
    """Follow (q, v, a) of a function of time for hip pitch; what comes out, (ticks, 3, 6)."""
    config = GovernorConfig(share=share, time=0.015, level=level)
    governor = SwingGovernor(config, INERTIA, DAMPING, STALL)
    governor.begin(np.zeros(6), np.zeros(6), 0.0, np.full(3, more))
    track = []
    for tick in range(1, 90):
        targets = np.zeros((3, 6))
        targets[:, HIP] = wanted(tick * DT)
        governor.update(DT, *targets)
        track.append(targets)
    return np.array(track)


def test_a_motion_that_servos_can_do_is_followed_as_it_is():
    def slow(t):
        return 0.1 * (1 - np.cos(10 * t)), 1.0 * np.sin(10 * t), 10 * np.cos(10 * t)

    track = governed(slow)
    wanted = [slow(tick * DT)[0] for tick in range(1, 90)]
    np.testing.assert_allclose(track[:, 0, HIP], wanted, atol=0.005)


def test_a_jump_takes_no_more_torque_than_its_share():
    track = governed(lambda _: (-0.5, 0.0, 0.0), share=0.8)
    velocity, acceleration = track[:, 1, HIP], track[:, 2, HIP]
    before = np.concatenate(([0.0], velocity[:-1]))
    torque = np.abs(0.04 * acceleration + 0.851 * before)
    assert torque.max() == pytest.approx(0.8 * 4.1)
    assert np.abs(velocity).max() < 0.8 * 4.82
    assert track[-1, 0, HIP] == pytest.approx(-0.5, abs=0.01)


@pytest.mark.parametrize("level", [0.0, 0.5, 1.0])
def test_the_ankle_takes_up_its_share_of_what_the_hip_lags(level):
    track = governed(lambda _: (-0.3, 0.0, 0.0), level=level)
    lag = -0.3 - track[:, 0, HIP]
    late = slice(30, None)  # the ankle itself needs a moment
    np.testing.assert_allclose(track[late, 0, ANKLE], level * lag[late], atol=0.03)
    np.testing.assert_array_equal(track[:, 0, KNEE], 0.0)


def test_it_begins_where_the_leg_is():
    governor = SwingGovernor(GovernorConfig(share=0.8, time=0.015, level=0.5), INERTIA, DAMPING,
                             STALL)  # fmt: skip
    position, velocity = np.full(6, 0.2), np.full(6, 1.0)
    governor.begin(position, velocity, 0.002, np.zeros(3))
    targets = [np.full(6, 0.2 + 0.002 + DT), np.full(6, 1.0), np.zeros(6)]
    governor.update(DT, *targets)
    assert targets[0][HIP] == pytest.approx(0.202 + DT, abs=2e-4)


def test_a_heavier_rotor_is_given_more_time():
    track = governed(lambda _: (-0.5, 0.0, 0.0), share=0.8, more=0.015)
    velocity, acceleration = track[:, 1, HIP], track[:, 2, HIP]
    before = np.concatenate(([0.0], velocity[:-1]))
    torque = np.abs(0.055 * acceleration + 0.851 * before)
    assert torque.max() == pytest.approx(0.8 * 4.1)
