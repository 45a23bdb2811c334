"""The swing foot passes the stance foot at a distance."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.walking.leg_crossing import LegCrossing

GUARD = LegCrossing(0.07)
PLACE = st.floats(-0.5, 0.5)


@given(st.floats(-0.5, -0.01), st.floats(0.08, 0.4), st.floats(0.01, 0.5), PLACE,
       st.sampled_from((-1, 1)))  # fmt: skip
def test_path_keeps_its_ends_and_its_distance_beside_the_stance_foot(back, out, ahead, y, side):
    start, landing = (back, side * out), (ahead, y)
    for share in (0.0, 1.0):
        assert GUARD.sidestep(start, landing, share, side) == pytest.approx(0.0)
    beside = start[0] / (start[0] - landing[0])
    straight = start[1] + beside * (landing[1] - start[1])
    assert side * (straight + GUARD.sidestep(start, landing, beside, side)) >= 0.07 - 1e-9


def test_straight_path_with_room_stays_straight():
    assert GUARD.sidestep((-0.3, -0.12), (0.3, -0.1), 0.5, -1) == 0.0


def test_crossing_step_goes_by_the_via_point():
    """From 0.1 m on the left to 0.1 m on the right, straight through the stance ankle."""
    assert GUARD.sidestep((-0.3, 0.1), (0.3, -0.1), 0.5, 1) == pytest.approx(0.07)
    assert GUARD.sidestep((-0.3, 0.1), (0.3, -0.1), 0.25, 1) == pytest.approx(0.035)


def test_path_that_does_not_pass_the_stance_foot_is_left_alone():
    assert GUARD.sidestep((0.1, 0.1), (0.3, -0.1), 0.5, 1) == 0.0
    assert GUARD.sidestep((-0.3, 0.05), (0.3, -0.1), 0.5, 1) == 0.0
