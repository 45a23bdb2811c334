import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.errors import InputError
from hil.schedule import Operator, Schedules, parse_ball, parse_point, parse_push, parse_turn

finite = st.floats(-1e6, 1e6, allow_nan=False)
times = st.floats(0, 1e4, allow_nan=False)


@given(finite, times)
def test_a_point_is_read_as_it_was_written(value, time_s):
    assert parse_point("--speed", f"{value!r}@{time_s!r}") == (time_s, value)
    assert parse_point("--speed", f"{value!r}") == (0.0, value)


@given(st.tuples(finite, finite, finite), times, st.floats(1e-3, 1e3))
def test_a_push_is_read_as_it_was_written(force, start, duration):
    text = ",".join(map(repr, force)) + f"@{start!r}+{duration!r}"
    push = parse_push("--push", text)
    assert (push.force, push.start, push.duration) == (force, start, duration)


@given(st.text(max_size=12))
def test_any_text_is_a_point_or_an_input_error_that_says_the_form(text):
    try:
        time_s, value = parse_point("--speed", text)
    except InputError as error:
        assert "--speed" in str(error) and "V[@T]" in str(error)
    else:
        assert time_s >= 0 and math.isfinite(value)


@pytest.mark.parametrize("text", ["nan", "inf", "1e999", "0.1@nan", "0.1@-1", "", "@3", "1,2@3"])
def test_bad_points_are_refused(text):
    with pytest.raises(InputError, match="--lateral"):
        parse_point("--lateral", text)


@pytest.mark.parametrize("text", ["1,2@3+1", "1,2,3@4", "1,2,3@4+0", "1,2,3@-4+1", "nan,0,0@1+1"])
def test_bad_pushes_are_refused(text):
    with pytest.raises(InputError, match="--push"):
        parse_push("--push", text)


def test_a_turn_needs_its_time():
    assert parse_turn("--turn", "90@2") == (2.0, math.pi / 2)
    with pytest.raises(InputError, match="DEG@T"):
        parse_turn("--turn", "90")


def test_speed_is_linear_between_points_and_constant_after_the_last():
    operator = Operator(Schedules(speed=((2.0, 0.4), (0.0, 0.2))), default_speed=9.0)
    speeds = [operator.reference(time_s).speed for time_s in (-1.0, 0.0, 0.5, 1.0, 2.0, 50.0)]
    assert speeds == pytest.approx([0.2, 0.2, 0.25, 0.3, 0.4, 0.4])


def test_a_schedule_without_its_beginning_starts_from_the_default():
    operator = Operator(Schedules(speed=((4.0, 0.3),)), default_speed=0.1)
    assert operator.reference(0.0).speed == pytest.approx(0.1)
    assert operator.reference(2.0).speed == pytest.approx(0.2)


def test_two_points_at_one_time_are_a_step():
    operator = Operator(Schedules(speed=((0.0, 0.1), (1.0, 0.1), (1.0, 0.3))), 0.0)
    assert operator.reference(0.999).speed == pytest.approx(0.1)
    assert operator.reference(1.0).speed == pytest.approx(0.3)


def test_turns_add_up_and_come_at_their_time():
    operator = Operator(Schedules(turns=((5.0, -0.5), (2.0, 1.5))), 0.0)
    headings = [operator.reference(time_s).heading for time_s in (0.0, 1.99, 2.0, 4.9, 5.0)]
    assert headings == pytest.approx([0.0, 0.0, 1.5, 1.5, 1.0])


def test_overlapping_pushes_add_up_and_end():
    pushes = (parse_push("", "1,0,0@1+1"), parse_push("", "0,2,0@1.5+1"))
    operator = Operator(Schedules(pushes=pushes), 0.0)
    forces = [operator.push(time_s).tolist() for time_s in (0.9, 1.0, 1.6, 2.0, 2.5)]
    assert forces == [[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0], [0, 0, 0]]


@pytest.mark.parametrize(
    "text",
    ["5,1,2@3", "0,1,2,3@4", "5,0,0,0@1", "-1,1,0,0@1", "5,1,0,0@-1", "5,1,0,0", "5,nan,0,0@1"],
)
def test_bad_balls_are_refused(text):
    with pytest.raises(InputError, match="--ball"):
        parse_ball("--ball", text)


def test_each_ball_is_thrown_once_and_in_time():
    balls = (parse_ball("--ball", "1,2,0,0@2"), parse_ball("--ball", "5,0,-3,0@1"))
    operator = Operator(Schedules(balls=balls), 0.0)
    thrown = [operator.ball(time_s) for time_s in (0.9, 1.0, 1.1, 2.5, 3.0)]
    assert [None if ball is None else ball.mass for ball in thrown] == [None, 5.0, None, 1.0, None]
    assert thrown[1].velocity == (0.0, -3.0, 0.0)


def test_a_liquid_changes_linearly_and_is_told_to_the_controller():
    operator = Operator(
        Schedules(water=((0.0, 0.0), (10.0, 1.0)), density=((4.0, 1200.0), (6.0, 1000.0)),
                  viscosity=((0.0, 3.0),)), 0.5,
    )  # fmt: skip
    assert operator.medium(-1.0) == (0.0, 1000.0, 3.0)
    assert operator.medium(5.0) == pytest.approx((0.5, 1100.0, 3.0))
    reference = operator.reference(2.0)
    liquid = (reference.water_level, reference.liquid_density, reference.liquid_viscosity)
    assert liquid == pytest.approx((0.2, 1100.0, 3.0))
    assert operator.medium(99.0) == (1.0, 1000.0, 3.0)


def test_without_a_level_the_controller_hears_of_dry_land():
    assert Operator(Schedules(), 0.5).reference(3.0).water_level == 0.0
