"""Pendulum, placement, timing, swing path and feed-forward against independent arithmetic."""

import math

import mujoco
import numpy as np
import pytest
from servo_bench import minibiped

from controller.robot_model import RobotModel
from controller.walking.capture_placement import landing_point
from controller.walking.heading_frame import HeadingFrame
from controller.walking.pendulum import Pendulum
from controller.walking.pendulum_state import PendulumState
from controller.walking.servo_config import servo_walking_config
from controller.walking.step_timing import remaining_time
from controller.walking.support_force import SoleForce, SupportForce
from controller.walking.swing_trajectory import SwingTrajectory

CONFIG = servo_walking_config(minibiped())
OMEGA, PERIOD = 6.7, 0.3


def simulate(x, v, p, seconds, omega=OMEGA, steps=20000):
    """Integrate ẍ = ω²(x − p) by small steps."""
    dt = seconds / steps
    for _ in range(steps):
        v += omega**2 * (x - p) * dt
        x += v * dt
    return x, v


def test_prediction_agrees_with_integration():
    pendulum = Pendulum(OMEGA, PERIOD)
    x, v = simulate(0.01, 0.1, 0.004, 0.2)
    predicted = pendulum.predict(0.01 + 0.1 / OMEGA, 0.004, 0.2)
    assert x + v / OMEGA == pytest.approx(predicted, rel=1e-3)


@pytest.mark.parametrize(("speed", "width"), [(0.2, 0.0), (0.0, 0.1), (-0.1, 0.0)])
def test_placing_at_the_steady_start_repeats_the_step(speed, width):
    """Ten steps of exact placement: same speed, same sway."""
    pendulum = Pendulum(OMEGA, PERIOD)
    side, travelled = 1, 0.0
    capture = pendulum.steady_start(speed, -side * width)
    for _ in range(10):
        end = pendulum.predict(capture, 0.0, PERIOD)
        step = end - pendulum.steady_start(speed, side * width)
        travelled += step
        capture, side = end - step, -side
    assert travelled == pytest.approx(10 * speed * PERIOD, abs=1e-9)


def test_time_to_a_capture_point_inverts_the_prediction():
    pendulum = Pendulum(OMEGA, PERIOD)
    goal = pendulum.predict(0.02, 0.005, 0.17)
    assert pendulum.time_to(0.02, 0.005, goal) == pytest.approx(0.17)
    assert pendulum.time_to(0.02, 0.03, 0.1) is None


@pytest.mark.parametrize(
    ("capture", "expected"),
    [
        (0.030, "nominal"),
        (0.038, "sooner"),
        (0.022, "later"),
    ],
)
def test_step_time_follows_the_lateral_capture_point(capture, expected):
    pendulum = Pendulum(OMEGA, 0.275)
    goal = pendulum.predict(0.030, 0.0, 0.15)
    time = remaining_time(CONFIG.timing, pendulum, capture, 0.0, goal, -capture, 0.125, 0.15)
    assert {"nominal": time == 0.15, "sooner": time < 0.14, "later": time > 0.16}[expected]
    assert 0.125 + time <= CONFIG.timing.max_stretch * 0.275 + 1e-12


def test_a_capture_point_outside_the_stance_foot_asks_for_landing_now():
    time = remaining_time(CONFIG.timing, Pendulum(OMEGA, 0.275), 0.02, 0.0, -0.08, 0.02, 0.05, 0.22)
    assert time == pytest.approx(CONFIG.timing.min_time - 0.05)


def test_landing_stays_clear_of_the_stance_foot_and_within_reach():
    state = PendulumState(RobotModel(minibiped()), 0.275, 0.005)
    state.pendulum.omega = OMEGA
    for sign in (1, -1):
        for capture in ((0.0, 0.0), (0.5, 0.3), (-0.5, -0.3)):
            state.capture = capture
            x, y = landing_point(CONFIG.placement, state, (0, 0), (0, 0), 0.2, sign)
            assert abs(x) <= CONFIG.placement.max_length
            assert CONFIG.placement.min_width <= -sign * y <= CONFIG.placement.max_width


def test_swing_path_rests_above_its_target_and_reaches_its_height():
    swing = SwingTrajectory(CONFIG.swing)
    phases = np.linspace(0.0, 1.0, 201).tolist()
    start, target = (-0.05, 0.1), (0.05, 0.1)
    path = [swing.horizontal(phase, start, target) for phase in phases]
    assert path[0] == start
    np.testing.assert_allclose(path[-1], target)
    ahead = np.array(path)[:, 0]
    assert np.diff(ahead).min() >= 0.0
    # No faster than the mean by 1/(1 - r), and as fast as that for the time between the ramps.
    speed = np.diff(ahead) * 200 / 0.1
    assert speed.max() == pytest.approx(1.0 / (1.0 - CONFIG.swing.ramp))
    assert np.mean(speed > 0.99 * speed.max()) == pytest.approx(1 - 2 * CONFIG.swing.ramp, abs=0.02)
    lift = [swing.lift(phase, PERIOD) for phase in phases]
    assert max(lift) == pytest.approx(CONFIG.swing.height)
    assert lift[0] == pytest.approx(0.0)
    assert lift[-1] == pytest.approx(0.0, abs=1e-12)
    assert swing.lift(1.1, PERIOD) == pytest.approx(-CONFIG.swing.search_speed * PERIOD * 0.1)


def test_feed_forward_holds_the_robot_still_on_one_foot():
    """With these torques and the reaction on the sole, MuJoCo's dynamics accelerate nothing."""
    description = minibiped()
    robot = RobotModel(description)
    model, data = robot.model, robot.data
    data.qpos[robot.qpos_addresses] = description.start_position
    mujoco.mj_forward(model, data)
    point = robot.com.copy()
    point[2] = robot.corner_positions[0, 0, 2]
    force = np.array([0.0, 0.0, robot.weight])
    torque = SupportForce(robot).torques([SoleForce(0, point, force)])
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.dof_frictionloss[:] = 0.0
    data.qfrc_applied[robot.dof_addresses] = torque
    mujoco.mj_applyFT(
        model, data, force, np.zeros(3), point, robot.foot_bodies[0], data.qfrc_applied
    )
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qacc, 0.0, atol=1e-6)


def test_heading_frame_round_trip():
    frame = HeadingFrame()
    frame.set(math.pi / 2)
    assert frame.to_heading((0.0, 1.0)) == pytest.approx((1.0, 0.0))
    assert frame.to_heading(frame.to_world((0.3, -0.2))) == pytest.approx((0.3, -0.2))
