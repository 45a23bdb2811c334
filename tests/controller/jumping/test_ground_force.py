"""Corner forces: the wanted wrench where it can be had, never a pull, never beyond friction."""

import numpy as np
import pytest

from controller.jumping.ground_force import GroundForce

LEVERS = np.array([[x, y, -0.9] for x in (0.1, -0.05) for y in (0.12, 0.08, -0.08, -0.12)])
BEARING = np.ones(8, dtype=np.bool_)


@pytest.fixture
def ground():
    return GroundForce(690.0, 0.93, 0.6)


def wrench_of(forces):
    return np.concatenate((forces.sum(axis=0), np.cross(LEVERS, forces).sum(axis=0)))


def test_a_wrench_inside_the_support_is_given_exactly(ground):
    wanted = np.array([60.0, -20.0, 1100.0, 30.0, -25.0, 5.0])
    found = wrench_of(ground.spread(wanted, LEVERS, BEARING))
    assert np.allclose(found, wanted, rtol=0.01, atol=1.0)


def test_no_corner_pulls_and_the_force_stays_when_the_moment_cannot_be_had(ground):
    wanted = np.array([0.0, 0.0, 700.0, 0.0, 400.0, 0.0])
    forces = ground.spread(wanted, LEVERS, BEARING)
    assert (forces[:, 2] >= 0.0).all()
    assert forces[:, 2].sum() == pytest.approx(700.0, rel=0.25)
    assert 0.0 < wrench_of(forces)[4] < 360.0
    assert abs(forces[:, 0].sum()) < 330.0


def test_a_foot_in_the_air_carries_nothing(ground):
    bearing = BEARING.copy()
    bearing[[0, 1, 4, 5]] = False
    forces = ground.spread(np.array([0.0, 0.0, 700.0, 0.0, 0.0, 0.0]), LEVERS, bearing)
    assert not forces[~bearing].any() and forces[bearing, 2].sum() > 300.0


def test_friction_cuts_what_pulls_sideways(ground):
    forces = ground.spread(np.array([900.0, 0.0, 700.0, 0.0, -800.0, 0.0]), LEVERS, BEARING)
    across = np.hypot(forces[:, 0], forces[:, 1])
    assert (across <= 0.6 * forces[:, 2] + 1e-9).all()
