"""Rows of the process matrix with real processes on pseudo-terminals, once each.

What must happen is asserted, not when: the times are `python benchmarks/process_matrix.py`'s, on a
machine that is quiet. The fault comes while the body is still held, so that no walk can fall.
"""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import live_walk
import process_matrix

pytestmark = pytest.mark.pty
RATE_HZ = 75
AFTER_S = 0.3
HERE = ("SIGKILL", "suspended for good",
        "terminal closed (SIGHUP)", "space", "guardian killed",
        "one adapter pulled out")  # fmt: skip
"""One of every kind; tests/hil and tests/drivers have the others with one process."""
ROWS = {row.name: row for row in process_matrix.ROWS}


def measured(row, attempts=5):
    """A repetition in which nothing else went wrong: a busy machine has many faults of its own."""
    found = None
    for _ in range(attempts):
        found = process_matrix.measure(row, AFTER_S, RATE_HZ, live_walk.LIGHT) or found
        if found is not None and process_matrix.kept(row, found):
            return found
    pytest.fail(f"not once in {attempts} attempts: {found}")


@pytest.mark.parametrize("name", HERE)
def test_however_a_walk_ends_its_servos_torque_goes_off(name):
    found = measured(ROWS[name])
    reaction = found.reaction
    assert reaction.off_s == reaction.off_s, "a torque that stayed on"
    assert reaction.joints == (6 if ROWS[name].buses == 1 else 12)
    if name.startswith("suspended"):
        assert reaction.stopped_s < reaction.off_s  # the watchdogs were first
    if name == "one adapter pulled out":
        assert "cut the servo power by hand" in found.complaint
    if name == "space":
        assert "stopped by key space" in found.complaint


def test_a_recorder_that_dies_or_finds_no_room_ends_no_walk():
    """Both in one walk: first its file may not grow any more, then it is gone."""
    row = ROWS["recorder killed"]

    def both(walk):
        ROWS["disk full"].do(walk)
        row.do(walk)

    found = measured(replace(row, do=both, code=None))
    assert found.reaction.off_s == found.reaction.off_s
    ends = [fault for fault in found.faults if not fault.endswith(", none")]
    assert not any("recorder" in fault for fault in ends)


def deeds(*events):
    return [(time_ns, joint, what) for time_ns, joint, what in events]


def test_the_journal_is_read_as_it_should_be():
    story = deeds(
        (1, "a", "torque on"), (2, "b", "torque on"), (3, "c", "torque on"), (4, "c", "torque off"),
        (10, "a", "stopped"), (20, "b", "torque off"), (30, "a", "torque off"),
        (40, "a", "torque off"),
    )  # fmt: skip
    found = live_walk.reaction(story, [["a"], ["b", "c"]], 5)
    times = (found.frame_s, found.stopped_s, found.off_s)
    assert times == pytest.approx((25e-9, 15e-9, 25e-9))
    assert found.joints == 2
    never = live_walk.reaction(story[:5], [["a"], ["b", "c"]], 5)
    assert never.off_s != never.off_s and never.joints == 2
    late = live_walk.reaction(story, [["a"], ["b", "c"]], 15)
    assert late.stopped_s == pytest.approx(5e-9)  # a had been stopped before


def test_rows_of_processes_are_on_the_page():
    page = (Path(__file__).parents[2] / "docs" / "safety.md").read_text(encoding="utf-8")
    for row in process_matrix.ROWS:
        assert f"| {row.name} |" in page
