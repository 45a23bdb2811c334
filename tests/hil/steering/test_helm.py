import math

import pytest

from hil.robot_files import load_robot
from hil.schedule import Operator, Schedules
from hil.steering.helm import DEAD_MAN_S, Helm
from hil.steering.limits import SteerLimits, steer_limits
from hil.steering.words import Word

LIMITS = SteerLimits(forward=0.4, backward=-0.1, sideways=0.2, push=10.0)
RATE = 100


def make(dead_man=False, pushes=True, **schedules):
    operator = Operator(Schedules(**schedules), 0.15)
    return operator, Helm(LIMITS, RATE, dead_man=dead_man, pushes=pushes)


def test_a_word_acts_at_the_next_tick_and_holds():
    operator, helm = make()
    helm.post(Word("speed", (0.3,)))
    assert operator.reference(1.0).speed == 0.15
    helm.act(operator, 1.0)
    assert operator.reference(1.0).speed == 0.3
    assert operator.reference(50.0).speed == 0.3


def test_steering_one_axis_leaves_the_schedule_of_the_others():
    operator, helm = make(speed=((0.0, 0.1),), lateral=((0.0, 0.0), (10.0, 0.1)))
    helm.post(Word("speed", (0.2,)))
    helm.act(operator, 2.0)
    assert operator.reference(5.0).lateral == pytest.approx(0.05)
    assert operator.reference(5.0).speed == 0.2


@pytest.mark.parametrize(
    "word, axis, most",
    [("speed", "speed", 0.4), ("lateral", "lateral", 0.2)],
)
def test_no_word_gets_beyond_the_limits(word, axis, most):
    operator, helm = make()
    for value, bound in ((1e9, most), (-1e9, -0.1 if word == "speed" else -0.2)):
        helm.post(Word(word, (value,)))
        helm.act(operator, 0.0)
        assert getattr(operator.reference(0.0), axis) == bound


def test_a_heading_turns_steadily_and_not_at_once():
    operator, helm = make()
    helm.post(Word("heading", (math.radians(60),)))
    helm.act(operator, 10.0)
    assert operator.reference(10.0).heading == 0.0
    assert operator.reference(11.0).heading == pytest.approx(math.radians(30))
    assert operator.reference(30.0).heading == pytest.approx(math.radians(60))


@pytest.mark.parametrize("heading", [1e308, -1e308])
def test_a_heading_that_no_robot_reaches_is_still_a_number(heading):
    operator, helm = make()
    helm.post(Word("heading", (heading,)))
    helm.act(operator, 1.0)
    assert math.isfinite(operator.reference(600.0).heading)


def test_turns_in_one_burst_add_up():
    operator, helm = make(turns=((1.0, 0.5),))
    for _ in range(3):
        helm.post(Word("turn", (0.1,)))
    helm.act(operator, 5.0)
    assert operator.reference(60.0).heading == pytest.approx(0.8)


def test_a_push_reaches_the_world_of_a_simulation_only():
    operator, helm = make()
    helm.post(Word("push", (0.0, 99.0, -3.0, 0.1)))
    helm.act(operator, 2.0)
    assert operator.push(2.05).tolist() == [0.0, 10.0, -3.0]
    assert not operator.push(2.2).any()
    operator, helm = make(pushes=False)
    helm.post(Word("push", (0.0, 5.0, 0.0, 0.1)))
    helm.act(operator, 2.0)
    assert not operator.pushes


def silent_ticks(helm, operator, seconds, begin=0.0):
    return [helm.act(operator, begin + k / RATE) for k in range(round(seconds * RATE))]


def test_a_live_robot_that_is_steered_stops_on_the_spot_when_nobody_is_heard():
    operator, helm = make(dead_man=True)
    helm.post(Word("speed", (0.3,)))
    helm.post(Word("lateral", (0.1,)))
    told = silent_ticks(helm, operator, DEAD_MAN_S + 0.5)
    assert told.count(True) == 1
    reference = operator.reference(9.0)
    assert (reference.speed, reference.lateral) == (0.0, 0.0)


def test_a_hand_that_is_heard_keeps_it_walking():
    operator, helm = make(dead_man=True)
    helm.post(Word("speed", (0.3,)))
    for second in range(5):
        helm.post(Word("alive"))
        assert not any(silent_ticks(helm, operator, 1.5, 1.5 * second))
    assert operator.reference(9.0).speed == 0.3


def test_a_schedule_that_nobody_took_over_needs_no_hand():
    operator, helm = make(dead_man=True)
    assert not any(silent_ticks(helm, operator, 3 * DEAD_MAN_S))
    assert operator.reference(9.0).speed == 0.15


def test_limits_follow_the_robot_and_hold_its_own_default():
    small, tall = (steer_limits(load_robot(name)) for name in ("minibiped", "human"))
    assert 0.15 < small.forward < tall.forward
    assert small.backward < 0 and small.push == pytest.approx(0.5 * 2.62 * 9.81, rel=0.1)
