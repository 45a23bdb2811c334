"""Every row of the fault matrix: the whole dry run, a fault, and what the robot did about it."""

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_SPEC = importlib.util.spec_from_file_location(
    "fault_matrix", ROOT / "benchmarks" / "fault_matrix.py"
)
fault_matrix = importlib.util.module_from_spec(_SPEC)
sys.modules["fault_matrix"] = fault_matrix
_SPEC.loader.exec_module(fault_matrix)


@pytest.mark.parametrize("row", fault_matrix.ROWS, ids=lambda row: row.name)
def test_a_fault_has_the_reaction_that_is_promised_in_time(row):
    found = fault_matrix.measure(row)
    assert fault_matrix.as_promised(row, found), found


def test_every_row_of_the_page_is_a_row_of_the_matrix():
    page = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    for row in fault_matrix.ROWS:
        assert f"| {row.name} |" in page
