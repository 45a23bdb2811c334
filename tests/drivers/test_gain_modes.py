"""Gains in current-based position mode and current mode, identified constants, and refusals."""

import numpy as np
import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.dynamixel.prediction import JointPrediction
from hil.errors import InputError
from hil.interface import JointCommand, Limit, SensorFrame
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN

N = 12
K_T = 12.0 / (46 * 2 * np.pi / 60)
"""V/w0 of XM430-W350."""
PER_COUNT = K_T * 0.00269
"""Torque of one current count [N·m]."""
DESCRIPTION = load_robot("minibiped")
PROVENANCE = {"date": "2026-01-01", "method": "ideal"}
FOUND = {
    "torque_constant": 2.0, "resistance": 8.0, "gain_divisor": 256, "armature": 0.02,
    "friction": 0.1, "viscous": 0.0, "delay": 0.003, "backlash": 0.01, "date": "2026-01-01",
    "method": "test",
}  # fmt: skip


def robot(**change):
    joints = [joint.model_copy(update=change) for joint in DESCRIPTION.joints]
    return DESCRIPTION.model_copy(update={"joints": tuple(joints)})


def mapping(servos=None, **change):
    data = {"robot": "minibiped", "provenance": PROVENANCE, "servos": servos or {}}
    return GainMapping(robot(**change), RobotCalibration.model_validate(data))


def command(position=0.1, stiffness=18.9, damping=0.6, velocity=0.0, torque=0.0):
    values = (position, velocity, stiffness, damping, torque)
    return JointCommand(*(np.full(N, float(value)) for value in values))


def frame(position=0.05, velocity=0.0, time_ns=0):
    made = SensorFrame.empty(N)
    made.joint_position[:], made.joint_velocity[:] = position, velocity
    made.joint_age_ns[:], made.time_ns = 0, time_ns
    return made


# Current-based position mode: K = P·c/128·(current of a count)·k_t, whatever the supply.
def test_mode_5_makes_stiffness_by_current():
    one = mapping(mode="current_position")
    state = frame()
    goals, applied = one.map(command(), state)
    count = PER_COUNT * COUNTS_PER_RADIAN / 128
    assert goals.p_gain[0] == round(18.9 / count)
    np.testing.assert_allclose(applied.stiffness, goals.p_gain * count, rtol=1e-6)
    state.joint_voltage[:] = 9.0
    for tick in range(1, 300):
        state.time_ns = tick * 3_333_333
        goals, _ = one.map(command(), state)
    assert one.voltage < 10.5
    assert goals.p_gain[0] == round(18.9 / count)


def test_mode_5_shifts_its_goal_by_all_of_the_damping():
    goals, applied = mapping(mode="current_position").map(command(velocity=1.0), frame())
    np.testing.assert_allclose(
        (goals.position - 2048) / COUNTS_PER_RADIAN, 0.1 + 0.6 / applied.stiffness, atol=8e-4
    )
    np.testing.assert_allclose(applied.damping, 0.6)


def test_mode_5_limits_the_current_to_the_joints_torque():
    goals, applied = mapping(mode="current_position", torque_limit=1.0).map(command(), frame())
    assert goals.current.tolist() == [int(1.0 / PER_COUNT)] * N
    # Full effort is 1 N·m here: 1/18.9 rad.
    assert not (applied.limit & int(Limit.SATURATION)).any()
    _, applied = mapping(mode="current_position", torque_limit=1.0).map(command(0.11), frame())
    assert (applied.limit & int(Limit.SATURATION)).all()


def test_mode_0_sends_the_torque_as_a_current():
    goals, applied = mapping(mode="current").map(command(torque=0.3), frame())
    asked = 18.9 * (0.1 - 0.05) + 0.3
    np.testing.assert_allclose(goals.current, round(asked / PER_COUNT))
    np.testing.assert_allclose(applied.torque, 0.3, atol=0.5 * PER_COUNT)
    assert applied.stiffness[0] == 18.9


def test_mode_0_follows_the_servos_direction():
    goals, _ = mapping(mode="current", direction=-1).map(command(), frame())
    assert goals.current[0] == -round(18.9 * 0.05 / PER_COUNT)


def test_a_current_beyond_the_limit_is_clipped_and_reported():
    goals, applied = mapping(mode="current", torque_limit=1.0).map(command(0.3), frame())
    assert goals.current.tolist() == [int(1.0 / PER_COUNT)] * N
    assert (applied.limit & int(Limit.SATURATION)).all()
    np.testing.assert_allclose(applied.torque, 1.0 - 18.9 * 0.25, atol=PER_COUNT)


def test_a_robot_in_position_mode_writes_no_currents():
    goals, _ = mapping().map(command(), frame())
    assert goals.current is None


@pytest.mark.parametrize("servo", ["XL430-W250", "XL330-M288", "XC330-T181", "MX-28"])
@pytest.mark.parametrize("mode", ["current", "current_position"])
def test_servos_that_cannot_regulate_their_motors_current_are_refused(servo, mode):
    with pytest.raises(InputError, match=f"{servo} cannot make .* in mode {mode}; valid: position"):
        mapping(servo=servo, mode=mode, stiffness=1.0, damping=0.1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mode": "current", "stiffness": 500.0}, "stiffness 500 .*mode current; feasible: 0 to"),
        ({"mode": "current", "damping": 2.0}, "damping 2 .*mode current; feasible: 0 to 1.7"),
        (
            {"mode": "current_position", "damping": 1.8},
            "damping 1.8 .*mode current_position; feasible: 0",
        ),
        ({"damping": 0.5}, "damping 0.5 .*mode position; feasible: 0.834 to 1.7"),
    ],
)
def test_what_a_mode_cannot_do_is_refused_with_its_range(change, message):
    with pytest.raises(InputError, match=f"left_hip_yaw: XM430-W350 cannot have {message}"):
        mapping(**change)


def test_more_stiffness_than_the_host_can_make_is_clamped_while_walking():
    _, applied = mapping(mode="current").map(command(stiffness=1e4), frame())
    assert applied.stiffness[0] < 300
    assert (applied.limit & int(Limit.STIFFNESS)).all()


# K = P·c/(885·256)·V·k_t/R with the constants found, not those of the data sheet.
def test_identified_constants_are_what_gains_are_made_with():
    one = mapping(servos={"left_knee": FOUND}, damping=0.9)
    goals, applied = one.map(command(damping=0.9), frame())
    knee = DESCRIPTION.joint_names.index("left_knee")
    per_count = 12.0 * 2.0 / 8.0 * COUNTS_PER_RADIAN / (885 * 256)
    assert goals.p_gain[knee] == round(18.9 / per_count)
    assert goals.p_gain[0] != goals.p_gain[knee]
    np.testing.assert_allclose(applied.stiffness, 18.9, rtol=0.001)


def test_a_calibration_of_a_stranger_is_refused():
    data = {"robot": "minibiped", "provenance": PROVENANCE, "servos": {"tail": FOUND}}
    with pytest.raises(InputError, match="servos: no joint tail; valid: left_hip_yaw"):
        RobotCalibration.model_validate(data).check_against(DESCRIPTION)


# A joint that accelerates at a: after T it has moved by vT + aT²/2 and is faster by aT.
def test_the_state_is_predicted_to_the_middle_of_its_goals_life():
    period, latency, acceleration = 1 / 300, 0.0027, 40.0
    one = JointPrediction(N, latency)
    for tick in range(3):
        time = tick * period
        position, velocity = 0.5 * acceleration * time**2, acceleration * time
        one.update(frame(position, velocity, 1_000_000_000 + round(time * 1e9)))
    later = time + latency + period / 2
    np.testing.assert_allclose(one.velocity, acceleration * later, rtol=1e-6)
    np.testing.assert_allclose(one.position, 0.5 * acceleration * later**2, rtol=1e-6)


def test_nothing_is_predicted_over_a_pause():
    one = JointPrediction(N, 0.003)
    one.update(frame(0.0, 0.0, 1_000_000_000))
    one.update(frame(0.1, 3.0, 2_000_000_000))
    np.testing.assert_allclose(one.velocity, 3.0)
