"""What is measured in a recording, on records whose every constant is known."""

import mujoco
import numpy as np
import pytest

from hil.after.differences import joint_curves
from hil.after.fitting import fit
from hil.after.load_model import LoadModel
from hil.after.measured_motion import continuous
from hil.after.motor_signs import motor_signs
from hil.after.recorded import RecordedRun
from hil.after.smoothing import parabolas
from hil.after.sole_signs import sole_signs
from hil.body_motion import BodyMotion
from hil.compose import driver_motors
from hil.record_layout import tick_dtype
from hil.recording import Recording
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN, PWM_FULL

RATE, TICKS, JOINTS = 300, 3000, 12
ROBOT = load_robot("minibiped")


def blank(ticks=TICKS):
    rows = np.zeros(ticks, tick_dtype(JOINTS, truth=False))
    rows["time_s"] = np.arange(ticks) / RATE
    rows["timing"]["tick"] = np.arange(ticks)
    rows["safety"]["walking"] = True
    rows["status"]["walking"] = True
    rows["frame"]["joint_voltage"] = 12.0
    rows["frame"]["imu_orientation"][:, 0] = 1.0
    rows["estimate"]["base_orientation"][:, 0] = 1.0
    return rows


def recorded(rows, **meta):
    known = {"joints": list(ROBOT.joint_names), "rate_hz": RATE, "weight_n": 26.0,
             "rung": "dry run", "started": "one"}  # fmt: skip
    return RecordedRun("run", Recording({**known, **meta}, rows, True), ROBOT)


def test_parabolas_have_no_lag_and_the_right_derivatives():
    time = np.arange(200) / RATE
    value, slope, bend = parabolas(3.0 - 2.0 * time + 5.0 * time**2, RATE)
    inside = slice(10, -10)
    assert value[inside] == pytest.approx((3.0 - 2.0 * time + 5.0 * time**2)[inside])
    assert slope[inside] == pytest.approx((-2.0 + 10.0 * time)[inside])
    assert bend[inside] == pytest.approx(10.0)
    value, slope, bend = parabolas(3.0 - 2.0 * time, RATE)  # also at the ends
    assert slope == pytest.approx(-2.0)
    assert np.abs(bend).max() < 1e-6


def test_a_fit_says_how_sure_it_is():
    random = np.random.default_rng(1)
    table = np.column_stack((random.normal(size=4000), np.ones(4000)))
    values, deviations = fit(table, table @ (2.0, 1.0) + 0.5 * random.normal(size=4000))
    assert values == pytest.approx((2.0, 1.0), abs=0.03)
    assert deviations == pytest.approx(0.5 / np.sqrt(4000), rel=0.6)


@pytest.mark.parametrize("lag", [1, 2, 3])
def test_motor_constants_and_delay_come_back(lag):
    motors, time = driver_motors(ROBOT), np.arange(TICKS) / RATE
    rows = blank()
    constant = 0.8 * motors.torque_constant
    position = np.sin(2 * np.pi * 1.3 * time)[:, None] * np.linspace(0.2, 0.4, JOINTS)
    speed = np.gradient(position, 1 / RATE, axis=0)
    goal = np.roll(position, -3, axis=0) + 0.02 * np.sin(2 * np.pi * 5.1 * time)[:, None]
    gain = 800
    duty = gain * COUNTS_PER_RADIAN * (np.roll(goal, lag, axis=0) - position)
    volts = 12.0 * duty / (PWM_FULL * motors.gain_divisor)
    assert np.abs(volts).max() < 12.0
    current = (volts - constant * speed) / (1.1 * motors.resistance)
    rows["frame"]["joint_position"], rows["frame"]["joint_velocity"] = position, speed
    rows["frame"]["joint_torque"] = current * motors.torque_constant
    rows["applied"]["goal"], rows["applied"]["p_gain"] = goal, gain
    signs = motor_signs(recorded(rows), motors)
    assert signs.delay[0] == pytest.approx(lag / RATE, abs=2e-4)
    assert signs.torque_constant[0] == pytest.approx(0.8, abs=0.01)
    assert signs.drive[0] == pytest.approx(1 / 1.1, abs=0.01)


def test_a_joint_that_hardly_moves_says_nothing_of_its_torque_constant():
    rows = blank()
    rows["frame"]["joint_velocity"] = 0.1
    rows["applied"]["goal"] = 0.1 + 0.01 * np.random.default_rng(0).normal(size=(TICKS, JOINTS))
    rows["applied"]["p_gain"] = 800
    signs = motor_signs(recorded(rows), driver_motors(ROBOT))
    assert np.isnan(signs.torque_constant[0]).all()
    assert np.isinf(signs.torque_constant[1]).all()


def standing(ticks=1):
    zero = np.zeros((ticks, 3))
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (ticks, 1))
    corners, shear = np.zeros((ticks, 2, 4)), np.zeros((ticks, 2, 2))
    return BodyMotion(zero, zero, zero, upright, zero, zero, corners, shear)


def test_feet_that_carry_the_weight_unload_the_hand_and_load_the_knees():
    model = LoadModel(ROBOT)
    angles = np.array([ROBOT.start_position])
    still = np.zeros_like(angles)
    hanging, stood = standing(), standing()
    stood.corners[:] = model.mass * 9.81 / 8
    names = list(ROBOT.joint_names)
    knee, roll = names.index("left_knee"), names.index("left_ankle_roll")
    free = model.torques(hanging, angles, still, still)[0]
    loaded = model.torques(stood, angles, still, still)[0]
    body = mujoco.MjModel.from_xml_path(str(ROBOT.model_path))
    data = mujoco.MjData(body)
    for name, angle in zip(names, angles[0], strict=True):
        data.joint(name).qpos = angle
    mujoco.mj_kinematics(body, data)
    lever = data.geom("left_sole").xpos[0] - data.joint("left_knee").xanchor[0]
    assert lever < -0.02  # the sole is behind the bent knee
    assert loaded[knee] - free[knee] == pytest.approx(model.mass * 9.81 / 2 * lever, abs=0.01)
    assert loaded[roll] == pytest.approx(free[roll], abs=0.02)
    pushed = standing()
    pushed.corners[:, :, [0, 2]] = model.mass * 9.81 / 4  # both feet on their left edges
    assert abs(model.torques(pushed, angles, still, still)[0, roll]) > 0.2


def test_a_sole_that_lies_flat_shows_a_joint_zero_and_only_in_its_leg():
    rows = blank(600)
    rows["frame"]["joint_position"] = ROBOT.start_position
    names = list(ROBOT.joint_names)
    rows["frame"]["joint_position"][:, names.index("left_knee")] += 0.03
    rows["frame"]["joint_position"][:, names.index("right_ankle_roll")] -= 0.02
    rows["frame"]["foot_force"] = 4.0
    signs = sole_signs(recorded(rows), LoadModel(ROBOT))
    assert np.degrees(signs.lean[0]) == pytest.approx(np.degrees([0.03, 0.0]), abs=0.05)
    assert np.degrees(signs.lean[1]) == pytest.approx(np.degrees([0.0, -0.02]), abs=0.05)


def test_quaternions_do_not_jump():
    one = np.array([[0.6, 0.8, 0, 0], [-0.6, -0.8, 0, 0], [0.61, 0.79, 0, 0]])
    assert (continuous(one)[:, 0] > 0).all()


def strides(step_ticks, shift):
    rows = blank()
    step = np.arange(TICKS) // step_ticks
    rows["status"]["stance"] = step % 2
    phase = (np.arange(TICKS) % (2 * step_ticks)) / (2 * step_ticks)
    rows["frame"]["joint_position"] = np.sin(2 * np.pi * phase)[:, None]
    rows["frame"]["joint_position"][:, 4] += shift
    return recorded(rows, started=str(step_ticks))


def test_walks_of_different_step_times_are_laid_over_each_other():
    curves = joint_curves(strides(90, 0.0), strides(75, 0.1))
    position, _ = curves.rms()
    assert curves.aligned == "phase"
    assert curves.strides[0] < curves.strides[1]
    assert position[4] == pytest.approx(0.1, abs=0.01)
    assert np.delete(position, 4).max() < 0.02


def test_a_twin_is_compared_tick_by_tick_also_where_ticks_are_missing():
    first = strides(90, 0.0)
    rows = np.delete(strides(90, 0.0).recording.rows, [800, 801, 1500])
    rows["frame"]["joint_torque"][:, 2] = 0.5
    twin = recorded(rows, rung="twin", twin_of={"name": "run", "started": "90"}, started="later")
    curves = joint_curves(first, twin)
    position, torque = curves.rms()
    assert curves.aligned == "tick"
    assert position.max() == 0.0
    assert torque[2] == pytest.approx(0.5)
