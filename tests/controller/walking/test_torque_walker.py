"""The human walks, and each component that is taken away is missed."""

import numpy as np
import pytest

from controller.walking.torque_walker import TorqueWalker
from hil.errors import DescriptionError
from hil.interface import Estimate, Reference
from hil.robot_files import load_robot

from .conftest import HumanWalk


@pytest.mark.parametrize(
    ("rate", "pd"), [(300, "explicit"), (225, "explicit"), (300, "implicit"), (120, "implicit")]
)
def test_walks_at_the_commanded_speed(rate, pd):
    human = HumanWalk(rate, pd).walk(8.0)
    assert not human.fell
    assert 15 <= human.steps <= 18
    forward, left = human.mean_velocity(3.0)
    assert forward == pytest.approx(0.5, rel=0.05)
    assert abs(left) < 0.03


def test_stance_foot_lies_flat_most_of_its_time():
    human = HumanWalk().walk(2.0)
    flat = loaded = 0
    for _ in range(600):
        estimate = human.tick()
        status = human.walker.status
        corners = estimate.foot_force[status.stance]
        if status.foot_flat and corners.sum() > 100.0:
            loaded += 1
            flat += (corners > 10.0).sum() >= 3
    assert loaded > 400
    assert flat / loaded > 0.8


def test_sideways():
    human = HumanWalk()
    human.reference.lateral = 0.2
    human.walk(8.0)
    assert not human.fell
    assert human.mean_velocity(4.0)[1] == pytest.approx(0.2, abs=0.03)


def test_speeds_up_and_slows_down_from_a_jump_of_the_command():
    human = HumanWalk(speed=0.35).walk(4.0)
    human.reference.speed = 0.7
    assert human.walk(6.0).mean_velocity(2.0)[0] == pytest.approx(0.7, rel=0.05)
    assert not human.fell


@pytest.mark.parametrize("degrees", [90, -115])
def test_turns(degrees):
    human = HumanWalk().walk(3.0)
    human.reference.heading = np.deg2rad(degrees)
    human.walk(4.5)
    assert not human.fell
    assert human.yaw == pytest.approx(np.deg2rad(degrees), abs=0.15)
    assert human.walker.status.heading == pytest.approx(np.deg2rad(degrees))


@pytest.mark.parametrize(("rate", "pd"), [(300, "explicit"), (300, "implicit")])
@pytest.mark.parametrize("side", [1, -1])
def test_survives_a_push_to_the_side(rate, pd, side):
    """The seed's own protocol: 100 N for 0.3 s at the pelvis."""
    human = HumanWalk(rate, pd).walk(3.0)
    human.plant.set_push(np.array([0.0, side * 100.0, 0.0]))
    human.walk(0.3)
    human.plant.set_push(np.zeros(3))
    assert not human.walk(3.5).fell


@pytest.mark.parametrize(
    ("pd", "side", "start"), [("explicit", 1, 4.48), ("explicit", -1, 4.36), ("implicit", 1, 4.0)]
)
def test_foot_does_not_roll_over_its_edge_after_a_strong_push(pd, side, start):
    """250 N: the ground's horizontal force alone would tip the foot that catches the body.

    The explicit ones begin when a limit that took that force for zero would let the human fall.
    """
    human = HumanWalk(300, pd).walk(start)
    human.plant.set_push(np.array([0.0, side * 250.0, 0.0]))
    human.walk(0.3)
    human.plant.set_push(np.zeros(3))
    assert not human.walk(3.0).fell


def test_falls_without_the_ankle_limit():
    """Nothing else yet keeps a 5 cm wide sole from tipping over its edge."""
    assert HumanWalk(ankle_limit=False).walk(6.0).fell


def without(section, **changes):
    """An override that changes keys of one walking section."""
    values = {**load_robot("human").walking[section], **changes}
    return (f"walking.{section}={values}",)


@pytest.mark.parametrize(
    "overrides",
    [
        pytest.param(without("placement", gain=[1e-6, 1e-6]), id="pendulum"),
        pytest.param(without("swing_leg", rate_limit=1e-6, reach=0.5), id="swing leg"),
    ],
)
def test_falls_without(overrides):
    assert HumanWalk(overrides=overrides).walk(6.0).fell


def test_slow_without_the_alteration():
    """Frozen at 0 the virtual force alone does not reach the commanded speed."""
    human = HumanWalk(overrides=without("alteration", gain=0.0, start=0.0)).walk(8.0)
    assert human.fell or human.mean_velocity(4.0)[0] < 0.4


def test_wanted_speed_is_the_commanded_one_with_the_learned_curve_and_its_offset():
    human = HumanWalk(speed=0.3)
    human.reference.speed = 0.6
    human.walk(2.0)
    plan = human.walker._plan
    shape = plan._learned.deviation(plan.gait.stance, plan.gait.phase)
    offset = plan._offset.value
    assert abs(offset[0]) > 0.001, "the speed is not yet the commanded one"
    assert plan.wanted == pytest.approx((0.6 + shape[0] + offset[0], shape[1] + offset[1]))


@pytest.mark.parametrize(
    ("pd", "degrees", "start"),
    [("explicit", 150, 4.0), ("explicit", -150, 4.4), ("implicit", -150, 4.0)],
)
def test_turns_by_150_degrees(pd, degrees, start):
    """The foot that lands first bounces: its leg must not fly off while it is in the air.

    Both explicit ones fall if the stance hip then has no torque.
    """
    human = HumanWalk(pd=pd).walk(start)
    human.reference.heading = np.deg2rad(degrees)
    human.walk(3.0)
    assert not human.fell
    assert human.yaw == pytest.approx(np.deg2rad(degrees), abs=0.15)


def test_turn_teaches_nothing():
    """In a frame that rotates under the body its speed is no measure of the gait."""
    human = HumanWalk().walk(4.0)
    plan = human.walker._plan
    before = plan.alteration.value, plan.coronal_alteration.value, plan._offset.value
    curve = plan._learned.values.copy()
    human.reference.heading = 1.5
    steps = human.steps
    while human.steps < steps + 4:
        human.tick()
        turned = abs(plan.heading_ramp.heading - 1.5) < 1e-9
        if turned:
            break
    human.walk(0.5)
    after = plan.alteration.value, plan.coronal_alteration.value, plan._offset.value
    assert turned
    assert after == before
    assert np.array_equal(plan._learned.values, curve)


def test_step_width_changes_during_the_walk():
    """Mean lateral distance of the ankles at touch-down, from step to step."""

    def ankle_distance(human):
        widths, steps = [], human.steps
        while len(widths) < 6:
            human.tick()
            if human.steps != steps:
                steps = human.steps
                left, right = human.walker._robot.ankles
                widths.append(abs(left[1] - right[1]))
        return np.mean(widths)

    human = HumanWalk().walk(4.0)
    own = ankle_distance(human)
    human.reference.step_width = 0.2
    human.walk(3.0)
    assert ankle_distance(human) > own + 0.05
    assert not human.fell


def test_strong_push_is_followed_by_recovery_steps_that_end():
    human = HumanWalk(225).walk(4.0)
    plan = human.walker._plan
    assert not plan.recovery.active
    human.plant.set_push(np.array([-150.0, 0.0, 0.0]))
    human.walk(0.3)
    human.plant.set_push(np.zeros(3))
    altered, recovered = plan.alteration.value, False
    for _ in range(round(4.0 * human.rate)):
        human.tick()
        recovered |= plan.recovery.active
    assert recovered
    assert not plan.recovery.active
    assert not human.fell
    assert altered < 0.0


def test_coronal_speed_is_exact_by_its_alteration():
    def coronal_speed(overrides):
        human = HumanWalk(overrides=overrides).walk(3.0)
        human.reference.lateral = 0.3
        human.walk(10.0)
        assert not human.fell
        return human.mean_velocity(5.0)[1]

    assert coronal_speed(()) == pytest.approx(0.3, abs=0.02)
    assert coronal_speed(("walking.coronal_alteration.gain=0.0",)) < 0.28


def test_walks_sideways_and_back_at_60_hz():
    """Coronal speed 0, 0.2, -0.2 m/s, five steps each: the seed's own cycle."""
    human = HumanWalk(60, "implicit")
    while human.time < 30.0 and not human.fell:
        human.reference.lateral = (0.0, 0.2, -0.2)[human.steps // 5 % 3]
        human.tick()
    assert not human.fell
    assert human.mean_velocity(20.0)[0] == pytest.approx(0.5, rel=0.05)


def test_gains_of_300_hz_need_implicit_pd_at_120_hz():
    """The seed's law: lower rates allow less gain; implicit PD lifts it."""
    gains = ("walking.gain_rate=300",)
    assert HumanWalk(120, overrides=gains).walk(3.0).fell
    assert not HumanWalk(120, "implicit", overrides=gains).walk(3.0).fell


def estimate_of(truth):
    n = len(truth.joint_position)
    return Estimate(
        0,
        truth.base_position.copy(),
        truth.base_orientation.copy(),
        truth.base_linear_velocity.copy(),
        truth.base_angular_velocity.copy(),
        truth.joint_position.copy() + np.linspace(0.0, 0.05, n),
        truth.joint_velocity.copy(),
        truth.com.copy(),
        truth.com_velocity.copy(),
        np.array([[150.0] * 4, [0.0] * 4]),
        np.zeros(2),
        np.array([True, False]),
        float("nan"),
    )


def first_torque(rate, pd):
    human = HumanWalk(300)
    description = load_robot("human", ("walking.gain_rate=300",))
    walker = TorqueWalker(description, rate, pd, True, 0.5)
    return walker.step(estimate_of(human.plant.truth()), Reference(speed=0.5)).torque


def test_implicit_becomes_explicit_as_the_period_vanishes():
    slow = np.abs(first_torque(300, "implicit") - first_torque(300, "explicit")).max()
    fast = np.abs(first_torque(1000000, "implicit") - first_torque(1000000, "explicit")).max()
    assert slow > 10.0
    assert fast < 0.1


def test_no_torque_once_fallen():
    human = HumanWalk()
    human.tick()
    estimate = estimate_of(human.plant.truth())
    estimate.base_position[2] = 0.3
    assert not human.walker.step(estimate, human.reference).torque.any()
    assert not human.walker.status.walking


def test_each_walk_is_repeatable():
    assert np.array_equal(HumanWalk().walk(1.0).velocity, HumanWalk().walk(1.0).velocity)


def test_mistake_in_the_walking_section_is_named():
    with pytest.raises(DescriptionError, match=r"walking\.gait\.period"):
        TorqueWalker(load_robot("human", ("walking.gait={min_phase: 0.4}",)), 300)
    with pytest.raises(DescriptionError, match=r"gain set 310 is not in gains; valid: 225"):
        TorqueWalker(load_robot("human", ("walking.gain_rate=310",)), 300)
