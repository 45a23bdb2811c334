"""Motor constants come out of what servos measure, in arithmetic and in a walk."""

import numpy as np
import pytest

from controller.estimation.sensors import SensorEstimator
from controller.walking.servo_walker import ServoWalker
from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.dynamixel.learned_motors import BATCH, BOUNDS, LearnedMotors
from drivers.motor_constants import motor_parameters
from hil.clock import tick_time_ns
from hil.interface import JointCommand, Reference, SensorFrame
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant

N, RATE, P_GAIN, SUPPLY = 12, 300, 800.0, 12.0
NOMINAL = RobotCalibration(robot="minibiped", provenance={"date": "2026-01-01", "method": "ideal"})
MOTORS = motor_parameters(load_robot("minibiped"), NOMINAL)
SWINGING = [2, 3, 8, 9]
"""Hip pitch and knee of both legs: the joints that turn fast enough to be learnt soon."""


def feed(learned, constant_scale, resistance_scale, ticks, amplitude=2.0, valid=True, current=0.6):
    """Servos whose speed and current swing out of phase, and what they measure of it."""
    k, r = MOTORS.torque_constant * constant_scale, MOTORS.resistance * resistance_scale
    changes = 0
    for tick in range(ticks):
        time = tick / RATE
        speed = amplitude * np.sin(8.0 * time + np.arange(N))
        amps = current * np.cos(5.0 * time + np.arange(N))
        duty = (r * amps + k * speed) / SUPPLY
        error = duty * 885.0 * MOTORS.gain_divisor / (P_GAIN * COUNTS_PER_RADIAN)
        frame = SensorFrame.empty(N)
        frame.joint_valid[:] = valid
        frame.joint_velocity[:] = speed
        frame.joint_torque[:] = amps * MOTORS.torque_constant
        sent = frame.joint_position + error
        changes += learned.take(frame, sent, np.full(N, P_GAIN), SUPPLY)
    return changes


@pytest.mark.parametrize(("scale", "warmth"), [(0.78, 1.0), (1.22, 1.1), (1.0, 0.9)])
def test_both_constants_are_found_within_seconds(scale, warmth):
    learned = LearnedMotors(MOTORS, RATE)
    assert feed(learned, scale, warmth, 10 * RATE) > 0
    np.testing.assert_allclose(learned.torque_constant / MOTORS.torque_constant, scale, atol=0.04)
    np.testing.assert_allclose(learned.resistance / MOTORS.resistance, warmth, atol=0.05)


def test_a_servo_that_is_as_its_data_sheet_changes_nothing():
    learned = LearnedMotors(MOTORS, RATE)
    assert feed(learned, 1.0, 1.0, 5 * RATE) == 0
    np.testing.assert_array_equal(learned.torque_constant, MOTORS.torque_constant)


def test_it_looks_once_a_batch():
    learned = LearnedMotors(MOTORS, RATE)
    assert feed(learned, 0.8, 1.0, BATCH - 1) == 0
    np.testing.assert_array_equal(learned.torque_constant, MOTORS.torque_constant)


@pytest.mark.parametrize(
    "samples", [{"amplitude": 0.3}, {"valid": False}, {"current": 0.0}], ids=str
)
def test_slow_silent_or_idle_servos_keep_their_data_sheet(samples):
    learned = LearnedMotors(MOTORS, RATE)
    assert feed(learned, 0.8, 1.0, 5 * RATE, **samples) == 0
    np.testing.assert_array_equal(learned.torque_constant, MOTORS.torque_constant)


def test_learnt_constants_stay_within_their_bounds():
    learned = LearnedMotors(MOTORS, RATE)
    feed(learned, 0.3, 1.0, 10 * RATE)
    lowest = BOUNDS[0] * MOTORS.torque_constant
    np.testing.assert_allclose(learned.torque_constant, lowest)


def test_gains_follow_the_servos_of_a_drawn_robot_while_it_walks():
    """A robot of seed 5: each servo's torque constant is another, and the mapping finds them."""
    description = load_robot("minibiped", ())
    mapping = GainMapping(description, NOMINAL)
    before = mapping.motor_parameters().torque_constant.copy()
    plant = Plant(description, RATE, 5, mapping.motor_parameters())
    backend = MujocoBackend(description, plant, mapping, RATE, 5)
    estimator, walker = SensorEstimator(description, RATE), ServoWalker(description, RATE)
    hold = JointCommand.zeros(N)
    hold.position[:] = description.start_position
    hold.stiffness[:] = [joint.stiffness for joint in description.joints]
    hold.damping[:] = [joint.damping for joint in description.joints]
    backend.open()
    backend.read()
    backend.arm()
    for tick in range(int(5.5 * RATE)):
        estimate = estimator.update(backend.read())
        walking = tick > RATE
        backend.write(walker.step(estimate, Reference(speed=0.15)) if walking else hold)
        if tick == RATE // 3:
            plant.set_support(False)
        backend.clock.sleep_until_ns(tick_time_ns(0, tick + 1, RATE))
    true = plant.servos.motors.torque_constant
    after = mapping.motor_parameters().torque_constant
    wrong_before, wrong_after = (np.abs(found / true - 1.0) for found in (before, after))
    assert wrong_before[SWINGING].max() > 0.10
    assert wrong_after[SWINGING].max() < 0.05
