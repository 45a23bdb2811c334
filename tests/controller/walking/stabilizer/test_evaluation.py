"""The equations of the evaluation, against numbers worked out by hand."""

import pytest

from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.distribution import distribution
from controller.walking.stabilizer.evaluation import Evaluation
from controller.walking.stabilizer.sample_box import SampleBox, sample_box
from controller.walking.stabilizer.trigger import triggered

EVALUATION = Evaluation(band=0.2, least_load=100.0)
EVEN = distribution([100.0, 100.0, 100.0, 100.0, 0.0])


def test_left_and_right_leave_the_toe_out_and_front_has_it():
    now = distribution([10.0, 30.0, 20.0, 140.0, 50.0])
    assert now[:4] == pytest.approx((30 / 200, 170 / 200, 90 / 250, 160 / 250))
    assert (now.sole, now.total) == (200.0, 250.0)
    assert distribution([0.0] * 5)[:4] == (0.0, 0.0, 0.0, 0.0)


def test_quality_adds_the_squares_of_what_sides_lack():
    now = distribution([10.0, 30.0, 10.0, 150.0, 0.0])  # left 0.1, right 0.9, front 0.2, rear 0.8
    assert EVALUATION.quality(now, flat=True) == pytest.approx(1000 * 0.1**2)
    now = distribution([10.0, 10.0, 10.0, 170.0, 0.0])  # left 0.1, front 0.1
    assert EVALUATION.quality(now, flat=True) == pytest.approx(1000 * 2 * 0.1**2)
    assert EVALUATION.quality(now, flat=False) == pytest.approx(1000 * 0.1**2)
    assert EVALUATION.quality(now, flat=False, band=0.15) == pytest.approx(1000 * 0.05**2)


def test_a_foot_with_less_load_is_always_worse():
    loads = (0.0, 10.0, 50.0, 99.0)
    values = [EVALUATION.quality(distribution([f / 4] * 4 + [0.0]), True) for f in loads]
    assert values == sorted(values, reverse=True)
    assert values[0] == pytest.approx(1e15)
    assert values[1] == pytest.approx(1e14)


def test_distance_is_two_sided_and_starts_from_what_is_acceptable():
    uneven = distribution([50.0, 150.0, 50.0, 150.0, 0.0])  # left 0.25, right 0.75
    assert EVALUATION.distance(uneven, EVEN, flat=True) == pytest.approx(10 * 2 * 0.25**2)
    edge = distribution([0.0, 200.0, 0.0, 200.0, 0.0])  # counts as left 0.2, right 0.8
    assert EVALUATION.distance(uneven, edge, flat=True) == pytest.approx(10 * 2 * 0.05**2)
    assert EVALUATION.total(uneven, edge, flat=True) == pytest.approx(10 * 2 * 0.05**2)
    assert EVALUATION.total(edge, edge, flat=True) == pytest.approx(10 * 1000 * 0.2**2 + 0.8)


def test_search_begins_below_the_trigger_band_of_a_loaded_foot():
    config = StabilizerConfig()

    def begins(left, load=400.0, flat=True, turned=False):
        part = [left / 2, (1 - left) / 2, left / 2, (1 - left) / 2]
        order = [part[i] for i in ((0, 2, 1, 3) if turned else (0, 1, 2, 3))]
        now = distribution([load * p for p in order] + [0.0])
        return triggered(config, EVALUATION, now, flat)

    assert begins(0.14) and begins(0.86)
    assert not begins(0.16) and not begins(0.84)
    assert not begins(0.0, load=90.0)
    assert begins(0.1, turned=True) and not begins(0.1, flat=False, turned=True)


def test_box_grows_with_weight_and_leg_and_stops_at_the_joints():
    room = ((-5.0, -100.0, -200.0), (100.0, 100.0, 200.0))
    box = sample_box(StabilizerConfig(), 650.0, EVEN, True, room)
    assert box.low == pytest.approx((-5.0, -20.0, -75.1), abs=0.1)
    assert box.high == pytest.approx((30.0, 20.0, 75.1), abs=0.1)
    small = sample_box(StabilizerConfig(), 6.5, EVEN, True, room)
    assert small.high == pytest.approx([v / 100 for v in box.high])
    assert sample_box(StabilizerConfig(), 650.0, EVEN, False, room).high[1] == pytest.approx(
        10.0, abs=0.1
    )


def test_coded_box_leans_towards_the_unloaded_side():
    room = ((-500.0,) * 3, (500.0,) * 3)
    config = StabilizerConfig(centre="coded")
    assert sample_box(config, 650.0, EVEN, True, room).centre == pytest.approx((10, 0, 50), abs=0.2)
    on_toes_and_left = distribution([100.0, 0.0, 0.0, 0.0, 50.0])
    pitch, roll, _ = sample_box(config, 650.0, on_toes_and_left, True, room).centre
    assert pitch == pytest.approx(-50.0, abs=0.2)
    assert roll == pytest.approx(10.0, abs=0.1)


def test_normalised_samples_stay_in_the_box():
    box = SampleBox((-1.0, 0.0, -4.0), (1.0, 2.0, 4.0))
    assert box.at((0.0, 0.0, 0.0)) == box.centre == (0.0, 1.0, 0.0)
    assert box.at((-3.0, 0.5, 9.0)) == (-1.0, 1.5, 4.0)
