"""Key-pose curves against the textbook spline."""

import numpy as np
import pytest

from controller.walking.key_poses import CurveTable, catmull_rom


def test_passes_through_its_knots_and_is_constant_outside():
    knots = [(0.02, 0.034), (0.5, 0.1), (0.98, 0.082)]
    values = catmull_rom(knots, np.array([-1.0, 0.02, 0.5, 0.98, 3.0]))
    assert values == pytest.approx([0.034, 0.034, 0.1, 0.082, 0.082])


def test_midpoint_of_the_uniform_spline():
    """(−p0 + 9·p1 + 9·p2 − p3)/16, the value of the classical Catmull-Rom matrix at ½."""
    p = [1.233, 0.851, 1.196, 0.487]
    value = catmull_rom([(0.1 * i, v) for i, v in enumerate(p)], np.array([0.15]))
    assert value[0] == pytest.approx((-p[0] + 9 * p[1] + 9 * p[2] - p[3]) / 16)


def test_straight_line_through_uneven_knots_stays_straight():
    phases = np.linspace(0.0, 1.0, 50)
    knots = [(x, 2.0 * x - 0.5) for x in (0.0, 0.1, 0.45, 0.5, 1.0)]
    assert catmull_rom(knots, phases) == pytest.approx(2.0 * phases - 0.5)


def test_table_agrees_with_the_splines_at_any_phase():
    curves = [[(0.0, 1.233), (0.1, 0.851), (0.2, 1.196), (1.0, -0.413)], [(0.28, 0.016)]]
    table = CurveTable(curves, end_phase=1.05)
    for phase in (-0.1, 0.0, 0.137, 0.5004, 1.0, 1.05, 1.3):
        expected = [catmull_rom(knots, np.array([phase]))[0] for knots in curves]
        assert table.at(phase) == pytest.approx(expected, abs=1e-3)
