"""A cell without signal is found out and replaced; one that lives is left alone."""

import numpy as np
import pytest

from controller.estimation.config import ContactConfig
from controller.estimation.contact import ContactDetector
from controller.estimation.dead_cells import SILENCE_S, DeadCells

WEIGHT, DT = 25.5, 1 / 300
LONG = round(1.2 * SILENCE_S / DT)
FORCES = [8.0, 5.0, 7.0, 4.0]
"""Linear over the sole."""


@pytest.mark.parametrize("corner", range(4))
def test_a_dead_cell_reads_what_a_rigid_sole_says(corner):
    cells = DeadCells(WEIGHT, DT)
    seen = list(FORCES)
    seen[corner] = 0.1
    for _ in range(LONG):
        repaired = cells.repair(0, seen)
    assert repaired == pytest.approx(FORCES)


def test_a_moment_on_an_edge_is_no_dead_cell():
    cells = DeadCells(WEIGHT, DT)
    edge = [12.0, 0.0, 12.0, 0.0]
    for _ in range(round(0.8 * SILENCE_S / DT)):
        assert cells.repair(0, edge) == edge


def test_a_foot_in_the_air_tells_nothing():
    cells = DeadCells(WEIGHT, DT)
    for _ in range(LONG):
        cells.repair(0, [0.0] * 4)
    assert cells.repair(0, [8.0, 5.0, 7.0, 0.0]) == [8.0, 5.0, 7.0, 0.0]


def test_a_cell_that_speaks_again_is_believed():
    cells = DeadCells(WEIGHT, DT)
    for _ in range(LONG):
        cells.repair(0, [8.0, 0.0, 7.0, 4.0])
    assert cells.repair(0, [8.0, 2.0, 7.0, 4.0]) == [8.0, 2.0, 7.0, 4.0]


def test_feet_are_judged_apart_and_never_pull():
    cells = DeadCells(WEIGHT, DT)
    for _ in range(LONG):
        cells.repair(0, [0.0, 1.0, 3.0, 12.0])
    assert cells.repair(0, [0.0, 1.0, 3.0, 12.0])[0] == 0.0
    assert cells.repair(1, [0.0, 5.0, 7.0, 4.0])[0] == 0.0


def test_the_detector_gives_repaired_forces():
    contact = ContactDetector(ContactConfig(), WEIGHT, DT, DeadCells(WEIGHT, DT))
    force = np.array([[0.0, 5.0, 7.0, 4.0], [0.0] * 4])
    for _ in range(LONG):
        contact.update(force)
    np.testing.assert_allclose(contact.force[0], FORCES, atol=1e-6)
    assert contact.loads[0] == pytest.approx(sum(FORCES))
