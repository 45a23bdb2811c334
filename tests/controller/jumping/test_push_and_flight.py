"""Plan, push, flight and landing, each alone."""

import numpy as np
import pytest

from controller.jumping.flight import FootFlight, time_to_fall
from controller.jumping.jump_plan import Heights, plan_jump
from controller.jumping.landing import Absorb
from controller.jumping.path import JumpTarget
from controller.jumping.support_polygon import SupportPolygon
from controller.jumping.thrust import Thrust

G, DT = 9.81, 1.0 / 300.0
HEIGHTS = Heights(1.03, 0.93, 0.91, 0.87)
FEET = np.array([0.1, 0.0, 0.0])


def plan(x=0.3, y=0.0, velocity=(0.0, 0.0)):
    target = JumpTarget((x, y, 0.0), 0.4, 0.3)
    return plan_jump(target, 70.4, HEIGHTS, FEET, np.array(velocity), np.zeros(2))


def test_the_feet_are_put_where_the_body_can_come_to_rest_over_them():
    jump = plan()
    behind = jump.path.landing[:2] - jump.landing_feet[:2]
    assert behind[0] < -0.02
    speed = jump.path.take_off_velocity[0]
    assert behind[0] + speed / np.sqrt(1.8 * G / HEIGHTS.touch_down) == pytest.approx(0, abs=1e-3)


def test_the_push_is_over_the_feet():
    path = plan().path
    force, start, end = path.force, path.start, path.take_off
    for com in (start, end):
        pressure = com[:2] - force[:2] / force[2] * com[2]
        assert np.abs(pressure - FEET[:2]).max() < 0.06


def test_a_body_that_walks_already_is_accelerated_less_and_crouches_further_back():
    still, walking = plan(0.4), plan(0.4, velocity=(0.5, 0.0))
    assert walking.path.acceleration[0] < 0.5 * still.path.acceleration[0]
    assert walking.crouch[0] < still.crouch[0] - 0.05
    assert walking.path.initial_velocity[0] == 0.5


def pushed(hinder):
    path = plan().path
    thrust, com, velocity = Thrust(path, DT), path.start.copy(), np.zeros(3)
    for tick in range(300):
        acceleration = thrust.acceleration(com, velocity)
        if thrust.over:
            break
        velocity = velocity + DT * (acceleration + hinder(tick))
        com = com + DT * velocity
    return path, com, velocity


def test_an_undisturbed_push_has_the_planned_acceleration():
    path, com, velocity = pushed(lambda _: np.zeros(3))
    assert velocity == pytest.approx(path.take_off_velocity, abs=0.06)
    assert com[2] == pytest.approx(path.take_off[2], abs=0.01)


def test_a_push_that_was_held_back_still_reaches_its_velocity():
    hold = np.array([-1.0, 0.5, -1.5])
    path, _, velocity = pushed(lambda tick: hold if tick < 60 else np.zeros(3))
    assert np.abs(velocity - path.take_off_velocity).max() < 0.12


def test_a_thrown_body_is_down_when_it_is_down():
    time = time_to_fall(0.05, 1.9, G)
    assert 0.05 + 1.9 * time - 0.5 * G * time**2 == pytest.approx(0.0, abs=1e-9)
    assert time_to_fall(-0.5, 1.0, G) == 0.0


def test_a_foot_is_where_it_should_be_when_the_body_lands():
    foot = FootFlight(np.array([0.0, 0.0, -0.9]), np.array([-0.3, 0.0, -1.9]), 0.4, DT)
    goal, speed = np.array([0.15, 0.02, -0.88]), np.array([-0.3, 0.0, 1.0])
    for tick in range(114):
        foot.step(goal, speed, 0.4 - tick * DT)
    assert foot.position == pytest.approx(goal - 6 * DT * speed, abs=0.01)


def test_a_landing_comes_to_rest_over_the_feet():
    support = SupportPolygon.of(np.array([[x, y] for x in (-0.07, 0.07) for y in (-0.12, 0.12)]))
    absorb, com = Absorb(G, 5.2), np.array([-0.12, 0.03, 0.91])
    velocity, goal, lowest = np.array([0.5, -0.1, -2.0]), np.array([0.0, 0.0, 0.87]), 1.0
    for _ in range(900):
        velocity = velocity + DT * absorb.acceleration(com, velocity, goal, 0.0, support)
        com = com + DT * velocity
        lowest = min(lowest, com[2])
    assert com == pytest.approx(goal, abs=0.01) and np.abs(velocity).max() < 0.01
    assert lowest > 0.6
