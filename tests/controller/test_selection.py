"""Selections that avoid copies select the same."""

import numpy as np
import pytest

from controller.selection import selection


@pytest.mark.parametrize("indices", [[3, 4, 5], [7], [], [2, 4, 5], [5, 4, 3]])
def test_selects_what_the_indices_select(indices):
    values, wanted = np.arange(10), np.array(indices, dtype=np.int64)
    assert values[selection(wanted)].tolist() == indices


def test_consecutive_entries_are_a_view():
    values = np.arange(10)
    values[selection(np.array([3, 4]))][:] = -1
    assert values.tolist() == [0, 1, 2, -1, -1, 5, 6, 7, 8, 9]
