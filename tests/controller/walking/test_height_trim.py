"""A foot that lands before it should is lifted higher; no foot is lowered."""

import numpy as np
import pytest

from controller.walking.height_trim import HeightTrim, HeightTrimConfig

CONFIG = HeightTrimConfig(gain=0.2, bound=0.006)
EVEN = [5.0] * 4


def landed(trim, foot, seen, loads=None, times=40):
    """`foot` lands so often, seen that high above the other one [m]."""
    corners = np.zeros((2, 4, 3))
    corners[foot, :, 2] = seen
    for _ in range(times):
        trim.land(foot, corners, [EVEN, EVEN] if loads is None else loads)
    return trim.value


def test_the_ground_is_where_a_foot_is_seen_to_land():
    trim = HeightTrim(CONFIG)
    assert landed(trim, 1, 0.004, times=1) == [0.0, pytest.approx(0.0008)]
    assert landed(trim, 1, 0.004) == [0.0, pytest.approx(0.004, abs=1e-5)]


def test_no_path_is_lowered_and_none_raised_beyond_the_bound():
    assert landed(HeightTrim(CONFIG), 0, -0.004) == [0.0, 0.0]
    assert landed(HeightTrim(CONFIG), 0, 0.05) == [0.006, 0.0]


def test_only_loaded_corners_stand_on_the_ground():
    heel_first = np.array([0.012, 0.012, 0.003, 0.003])
    loads = [[0.0, 0.0, 6.0, 6.0], EVEN]
    assert landed(HeightTrim(CONFIG), 0, heel_first, loads)[0] == pytest.approx(0.003, abs=1e-5)


def test_without_load_nothing_is_learnt():
    assert landed(HeightTrim(CONFIG), 0, 0.004, [EVEN, [0.0] * 4]) == [0.0, 0.0]
