"""What the pictures of a jump show, read from the axes themselves."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from hil.figures_jump import draw_com_path, draw_force_arrows, draw_jump_strip, draw_support
from hil.robot_files import load_robot


@pytest.fixture
def axes():
    return Figure().add_subplot()


def test_paths_are_seen_from_the_side(axes):
    planned = np.array([(0.0, 5.0, 1.0), (0.2, 5.0, 1.3), (0.4, 5.0, 1.0)])
    draw_com_path(axes, planned, np.add(planned, (0.0, 0.0, 0.01)))
    for line, shift in zip(axes.lines, (0.0, 0.01), strict=True):
        assert line.get_xdata() == pytest.approx(planned[:, 0])
        assert line.get_ydata() == pytest.approx(planned[:, 2] + shift)


def test_an_arrow_is_as_long_as_its_force(axes):
    draw_force_arrows(axes, np.array([(0.1, 9.0, 1.0)]), np.array([(100.0, 50.0, 900.0)]), 1e-3)
    [arrow] = axes.texts
    assert arrow.xyann == pytest.approx((0.1, 1.0))
    assert arrow.xy == pytest.approx((0.2, 1.9))


def test_the_support_is_seen_from_above_with_left_on_the_left(axes):
    vertices = np.array([(-0.1, -0.2), (0.1, -0.2), (0.1, 0.2), (-0.1, 0.2)])
    coms = np.array([(0.0, 0.0, 0.9), (0.03, 0.05, 0.7)])
    draw_support(axes, vertices, coms)
    [polygon] = axes.patches
    assert polygon.get_xy()[:4] == pytest.approx(vertices[:, ::-1])
    assert axes.lines[-1].get_xydata()[0] == pytest.approx((0.05, 0.03))
    assert axes.get_xlim()[0] > 0.2 > -0.2 > axes.get_xlim()[1]


@pytest.mark.parametrize(("spacing", "places"), [(0.0, (0.2, 0.7)), (1.5, (0.0, 1.5))])
def test_a_strip_puts_outlines_apart_or_where_they_are(axes, spacing, places):
    description = load_robot("minibiped")
    bases = np.array([(0.2, 0.0, 0.25), (0.7, 0.0, 0.24)])
    level = np.tile((1.0, 0.0, 0.0, 0.0), (2, 1))
    joints = np.zeros((2, len(description.joints)))
    draw_jump_strip(axes, description, bases, level, joints, ("a", "b"), spacing)
    assert [text.get_position()[0] for text in axes.texts] == pytest.approx(places)
    corners = np.vstack([patch.get_xy() for patch in axes.patches])
    # Straight legs stand on the ground with the root at 0.256 m.
    assert corners[:, 1].min() == pytest.approx(0.24 - 0.256, abs=2e-3)
    for place in places:
        assert np.abs(corners[:, 0] - place).min() < 0.05
