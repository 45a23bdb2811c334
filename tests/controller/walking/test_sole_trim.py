"""A sole that stands on its edge is turned until it lies flat."""

import pytest

from controller.walking.sole_trim import SoleTrim, SoleTrimConfig

STIFFNESS = 0.8
"""Motion of the cop per ankle angle [m/rad]: an edge of 36 mm at 2.6 degrees."""


def stand(trim, foot, tilt, steps):
    """Steps on a foot whose sole is tilted (pitch, roll) [rad]; where its cop is in the end."""
    for _ in range(steps):
        pitch, roll = (a + b for a, b in zip(tilt, trim.value[foot], strict=True))
        cop = STIFFNESS * pitch, -STIFFNESS * roll  # nose down loads the front, x up the right
        for _ in range(40):
            trim.add(cop)
        trim.end_step(foot)
    return cop


def test_the_cop_goes_where_it_is_wanted_on_the_foot_that_is_tilted():
    trim = SoleTrim(SoleTrimConfig(gain=0.3, bound=0.035))
    assert stand(trim, 1, (0.015, -0.02), 40) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert trim.value[1] == pytest.approx((-0.015, 0.02), abs=1e-3)
    assert trim.value[0] == (0.0, 0.0)


def test_it_turns_no_sole_beyond_the_bound_and_none_without_single_support():
    trim = SoleTrim(SoleTrimConfig(gain=0.3, bound=0.035))
    trim.end_step(0)
    assert trim.value[0] == (0.0, 0.0)
    stand(trim, 0, (0.2, 0.0), 40)
    assert trim.value[0][0] == pytest.approx(-0.035)
