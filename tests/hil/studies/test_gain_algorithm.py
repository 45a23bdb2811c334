"""Algorithm 1 on a made-up robot whose acceptable gains are known."""

import pytest

from hil.studies.gain_algorithm import Run, change, lower_frequency, optimize_frequency


class Robot:
    """Accepts 0.4 to 2·rate/1000 of 100 N·m/rad; a run gets halfway to the end of the range."""

    def __init__(self):
        self.calls = []

    def __call__(self, start, rate_hz, side, number):
        self.calls.append((rate_hz, side, number, start["knee"][0]))
        low, high = 40.0, 200.0 * rate_hz / 1000
        if high < low:
            return Run(start, False, 1e9, 150, 1, "still")
        stiffness, damping = start["knee"]
        goal = low if side == "min" else high
        found = {"knee": (0.5 * (stiffness + goal), damping)}
        return Run(found, True, 1.0, 10, 80, "iterations")


START = {"knee": (100.0, 10.0)}


def test_runs_repeat_while_the_gains_change_by_more_than_eta():
    robot = Robot()
    found = optimize_frequency(START, 1000, robot, eta=0.05, most_runs=10)
    starts = [start for _, side, _, start in robot.calls if side == "min"]
    assert starts == [100.0, 70.0, 55.0, 47.5, 43.75]
    assert found.smallest.last.gains["knee"][0] == pytest.approx(41.875)
    assert change({"knee": (43.75, 10.0)}, found.smallest.last.gains) <= 0.05


def test_the_largest_are_sought_from_the_smallest():
    robot = Robot()
    found = optimize_frequency(START, 1000, robot, eta=0.01, most_runs=20)
    first = next(start for _, side, _, start in robot.calls if side == "max")
    assert first == found.smallest.last.gains["knee"][0]
    assert found.largest.last.gains["knee"][0] == pytest.approx(200.0, rel=0.02)


def test_the_next_rate_starts_from_four_fifths_of_the_smallest():
    first, second = lower_frequency(START, (1000, 500), Robot(), eta=0.01, most_runs=20)
    low, high = (side.last.gains["knee"][0] for side in (first.smallest, first.largest))
    assert second.start["knee"][0] == pytest.approx(0.8 * low + 0.2 * high)
    assert second.largest.last.gains["knee"][0] == pytest.approx(100.0, rel=0.02)


def test_the_procedure_ends_at_the_first_rate_without_a_stable_motion():
    found = list(lower_frequency(START, (1000, 150, 100), Robot(), eta=0.1, most_runs=5))
    assert [rate.rate_hz for rate in found] == [1000, 150]
    assert found[1].largest is None
    assert not found[1].smallest.last.valid


def test_the_number_of_runs_has_a_limit():
    robot = Robot()
    optimize_frequency(START, 1000, robot, eta=1e-9, most_runs=3)
    assert len(robot.calls) == 6


def test_change_is_the_mean_square_of_the_relative_changes():
    before = {"hip": (100.0, 10.0), "toe": (0.0, 4.0)}
    after = {"hip": (110.0, 10.0), "toe": (5.0, 2.0)}
    assert change(before, after) == pytest.approx(((0.1**2 + 0.5**2) / 3) ** 0.5)
