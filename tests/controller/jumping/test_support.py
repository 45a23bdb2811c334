import numpy as np
import pytest
from jump_robots import ROBOTS, jumper

from controller.jumping.balance import balance_error
from controller.jumping.support_polygon import SupportPolygon
from hil.errors import InputError


def test_centre_and_margin_of_a_trapezium():
    """Parallel sides 3 and 1, height 2: centroid at h/3·(a + 2b)/(a + b) = 5/6 over the base."""
    corners = np.array([(0.0, 0.0), (3.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.5, 0.7)])
    polygon = SupportPolygon.of(corners)
    assert len(polygon.vertices) == 4
    assert polygon.centre == pytest.approx((1.5, 5.0 / 6.0))
    assert polygon.margin(np.array((1.5, 0.5))) == pytest.approx(0.5)
    assert polygon.margin(np.array((1.5, -0.2))) == pytest.approx(-0.2)
    assert polygon.margin(np.array((1.5, 2.1, 9.0))) == pytest.approx(-0.1)


def test_the_centre_does_not_depend_on_where_the_robot_is():
    corners = np.random.default_rng(3).uniform(-0.2, 0.2, (8, 2))
    shift = np.array((2e4, -1e4))
    near, far = SupportPolygon.of(corners), SupportPolygon.of(corners + shift)
    assert far.centre - shift == pytest.approx(near.centre, abs=1e-6)


def test_feet_on_a_line_support_nothing():
    with pytest.raises(InputError, match="one line"):
        SupportPolygon.of(np.array([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]))


@pytest.mark.parametrize("name", ROBOTS)
def test_the_support_of_a_standing_robot_is_the_seeds_quad(name):
    """Outer edges of the feet, a line between the toes and one between the heels."""
    robot = jumper(name)
    robot.model.set_state(robot.start)
    corners = robot.model.corner_positions
    polygon = SupportPolygon.of(corners)
    low, high = corners.reshape(-1, 3)[:, :2].min(axis=0), corners.reshape(-1, 3)[:, :2].max(axis=0)
    assert sorted(map(tuple, np.round(polygon.vertices, 6).tolist())) == sorted(
        (round(x, 6), round(y, 6)) for x in (low[0], high[0]) for y in (low[1], high[1])
    )
    error = balance_error(robot.model, polygon)
    assert error == pytest.approx(0.5 * (low + high) - robot.model.com[:2])
    assert polygon.margin(robot.model.com) > 0.0
