"""Operating modes, gains and limits of the servo, on the motors of a plant in the air."""

import numpy as np
import pytest

from hil.servo import COUNTS_PER_RADIAN, PWM_FULL
from sim_backends.motion_profile import VELOCITY_UNIT
from sim_backends.servo_firmware import (
    CURRENT,
    CURRENT_POSITION,
    PWM,
    VELOCITY,
    ServoConstants,
    ServoFirmware,
    senses_supply,
)
from sim_backends.virtual.motors import Motor, MotorBank, servo_models
from tests.sim_backends.conftest import run

KNEE = 3
K = 12.0 / (46 * 2 * np.pi / 60)
"""Torque constant of the XM430-W350 by its no-load speed [N·m/A]."""


@pytest.fixture
def desk(in_the_air):
    """A plant in the air without gravity or sag, and the motor of its left knee."""

    def make(*overrides):
        plant = in_the_air(*overrides)
        bank = MotorBank(plant, plant.servos, servo_models(plant.description))
        return plant, Motor(bank, KNEE)

    return make


def block(plant):
    """Keep the knee where it is for one look at the motor."""
    still = np.zeros(12)
    plant.servos.drive(plant.joint_position, still, still)
    return plant.servos


def test_current_mode_makes_the_torque_of_its_current(desk):
    """k·i at standstill and in motion, until the supply has no voltage left for it."""
    plant, motor = desk("joint_friction=0")
    motor.set_mode(CURRENT)
    motor.set_goal_current(100)
    assert block(plant).torque()[KNEE] == pytest.approx(100 * 0.00269 * K, rel=1e-6)
    moving = np.full(12, 2.0)
    plant.servos.drive(plant.joint_position, moving, moving)
    assert plant.servos.torque()[KNEE] == pytest.approx(100 * 0.00269 * K, rel=1e-6)
    fast = np.full(12, 5.5)
    plant.servos.drive(plant.joint_position, fast, fast)
    assert plant.servos.torque()[KNEE] < 0.0


def test_the_current_limit_bounds_current_mode(desk):
    plant, motor = desk()
    motor.set_mode(CURRENT)
    motor.set_limits(PWM_FULL, 50)
    motor.set_goal_current(-400)
    assert block(plant).current[KNEE] == pytest.approx(-50 * 0.00269)


def test_pwm_mode_gives_the_goal_duty_within_the_limit(desk):
    plant, motor = desk()
    motor.set_mode(PWM)
    motor.set_goal_pwm(-300)
    assert block(plant).duty[KNEE] == pytest.approx(-300 / 885)
    motor.set_limits(200, 1193)
    assert block(plant).duty[KNEE] == pytest.approx(-200 / 885)


def test_velocity_mode_reaches_its_goal_and_the_integral_closes_the_gap(desk):
    plant, motor = desk("joint_friction=0.2")
    speeds = []
    for gains in ((100, 0), (100, 1920)):
        motor.set_mode(VELOCITY)
        motor.set_velocity_gains(*gains)
        motor.set_goal_velocity(50)
        run(plant, 0.25)
        if gains[1]:  # the range of the joint ends after that
            run(plant, 0.5)
        speeds.append(plant.joint_velocity[KNEE] * COUNTS_PER_RADIAN / VELOCITY_UNIT)
    assert speeds[0] < 35
    assert speeds[1] == pytest.approx(50, abs=3)


def test_velocity_mode_speeds_up_at_the_profile_acceleration(desk):
    plant, motor = desk()
    motor.set_mode(VELOCITY)
    motor.set_velocity_gains(3000, 6000)
    motor.set_profile(0, 5)
    motor.set_goal_velocity(100)
    run(plant, 0.5)
    expected = 5 * 214.577 / 60 * 0.5 / 0.229
    assert motor.trajectory()[0] == pytest.approx(expected, abs=2)
    assert motor.reading().velocity == pytest.approx(expected, abs=8)


def test_current_based_position_is_a_spring_whatever_the_supply(desk):
    """Mode 5: the deflection under a load does not change with the voltage; mode 3's does."""
    bends = {}
    for mode in (3, CURRENT_POSITION):
        for volts in (12.0, 10.0):
            plant, motor = desk(f"supply.voltage={volts}", "joint_friction=0.0")
            motor.set_mode(mode)
            motor.set_goal_current(1193)
            motor.set_gains(800, 0, 4000 if mode == CURRENT_POSITION else 0)
            run(plant, 0.5)
            rest = plant.joint_position[KNEE]
            plant.data.qfrc_applied[6 + KNEE] = 1.0
            run(plant, 1.0)
            bends[mode, volts] = plant.joint_position[KNEE] - rest
    assert bends[3, 10.0] / bends[3, 12.0] == pytest.approx(1.2, abs=0.03)
    assert bends[5, 10.0] / bends[5, 12.0] == pytest.approx(1.0, abs=0.03)
    stiffness = 800 / 128 * COUNTS_PER_RADIAN * 0.00269 * K
    assert 1.0 / bends[5, 12.0] == pytest.approx(stiffness, rel=0.15)


def test_goal_current_is_the_limit_of_current_based_position(desk):
    plant, motor = desk()
    motor.set_mode(CURRENT_POSITION)
    motor.set_goal_current(80)
    motor.set_goal(4000)
    assert block(plant).current[KNEE] == pytest.approx(80 * 0.00269)


def test_the_integral_gain_takes_a_load_off_the_position_error(desk):
    errors = []
    for i_gain in (0, 2000):
        plant, motor = desk("joint_friction=0.0")
        motor.set_gains(800, i_gain, 0)
        plant.data.qfrc_applied[6 + KNEE] = 1.0
        run(plant, 1.5)
        errors.append(abs(plant.servos.goal[KNEE] - plant.servos.counts[KNEE]))
    assert errors[0] > 20
    assert errors[1] <= 2


def test_the_integral_stops_at_full_output(desk):
    """Long blocked, the joint comes back as soon as the goal does."""
    plant, motor = desk()
    motor.set_gains(800, 2000, 0)
    home = int(plant.servos.goal[KNEE])
    motor.set_goal(home + 600)
    for _ in range(1200):
        block(plant)
    motor.set_goal(home - 600)
    late = 0
    while block(plant).duty[KNEE] > 0.0:
        late += 1
    assert late * plant.model.opt.timestep < 0.25


def test_velocity_feed_forward_takes_the_lag_out_of_a_profile(desk):
    lags = []
    for feed_forward in (0, 1000):
        plant, motor = desk("joint_friction=0.0")
        motor.set_gains(800, 0, 0, feed_forward)
        motor.set_profile(60, 0)
        motor.set_goal(int(plant.servos.goal[KNEE]) + 500)
        run(plant, 0.3)
        lags.append(motor.trajectory()[1] - motor.reading().position)
    assert lags[0] > 15
    assert abs(lags[1]) < 0.4 * lags[0]


def test_acceleration_feed_forward_pushes_while_the_profile_speeds_up():
    constants = ServoConstants(K, 128.0, 128.0, 0.00269, senses_supply=False)
    duties = []
    for gain in (0, 16000):
        firmware = ServoFirmware(constants, 1 / 1200)
        firmware.p_gain, firmware.feed_forward_2 = 100, gain
        firmware.profile.configure(100, 50, False)
        duties.append(firmware.duty(2048.0, 0.0, 0.0, 3000.0, 12.0, 7.3))
    assert duties[1] > duties[0] + 0.01


def test_a_profile_moves_the_joint_in_its_own_time(desk):
    plant, motor = desk()
    motor.set_profile(800, 200, time_based=True)
    start = motor.reading().position
    motor.set_goal(start + 400)
    run(plant, 0.4)
    assert motor.reading().position - start == pytest.approx(200, abs=40)
    assert motor.trajectory()[1] - start == pytest.approx(200, abs=10)
    run(plant, 0.6)
    assert motor.reading().position - start == pytest.approx(400, abs=10)


def test_pwm_slope_is_a_lag_of_milliseconds():
    """XL330 e-manual: slope 140 takes 18 ms from 0 to full duty at 5 V."""
    constants = ServoConstants(0.46, 128.0, 128.0, 0.001, senses_supply=True)
    firmware = ServoFirmware(constants, 0.001)
    firmware.p_gain, firmware.pwm_slope = 16000, 140
    late = 1
    while firmware.duty(2048.0, 0.0, 0.0, 4000.0, 5.0, 3.0) < 1.0:
        late += 1
    assert late == pytest.approx(18, abs=1)


@pytest.mark.parametrize(("counts", "spin"), [(100, 0.0), (100, 3.0), (-200, 3.0), (50, -2.0)])
def test_a_servo_that_measures_its_supply_regulates_that(counts, spin):
    """u·i is the asked current, with i = (u·V − k·ω)/r (XL330 and XC330 e-manuals)."""
    assert senses_supply("XL330-M288")
    assert senses_supply("XC330-T288")
    assert not senses_supply("XM430-W350")
    volts, ohms, k = 5.0, 3.0, 0.46
    firmware = ServoFirmware(ServoConstants(k, 128.0, 128.0, 0.001, senses_supply=True), 0.001)
    firmware.mode, firmware.goal_current = CURRENT, counts
    duty = firmware.duty(2048.0, spin, spin, 0.0, volts, ohms)
    motor_current = (duty * volts - k * spin) / ohms
    assert abs(duty * motor_current) == pytest.approx(abs(counts) * 0.001)
    assert np.sign(motor_current) == np.sign(counts)


def test_only_what_uses_more_than_p_and_d_leaves_the_fast_path(desk):
    plant, motor = desk()
    firmware = plant.servos.firmware[KNEE]
    assert firmware.plain
    motor.set_gains(800, 1, 0)
    assert not firmware.plain
    motor.set_gains(800, 0, 100)
    assert firmware.plain
    motor.set_pwm_slope(140)
    assert not firmware.plain


def test_the_fast_path_and_the_loop_agree():
    """P and D of the plant's own arithmetic against the firmware's."""
    constants = ServoConstants(K, 128.0, 128.0, 0.00269, senses_supply=False)
    firmware = ServoFirmware(constants, 1 / 1200)
    firmware.p_gain, firmware.d_gain = 700, 900
    expected = (700 / 128 * 30 - 900 / 16 * 0.001 * 1.5 * COUNTS_PER_RADIAN) / 885
    assert firmware.duty(2048.0, 1.5, 1.5, 2078.0, 12.0, 7.3) == pytest.approx(expected)
