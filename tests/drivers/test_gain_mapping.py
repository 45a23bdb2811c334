"""Stiffness, damping and torque to registers, with the published constants of XM430-W350."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from hil.errors import InputError
from hil.interface import JointCommand, Limit, SensorFrame
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN

N = 12
KNEE = 3
OWN_DAMPING = 0.8511
PROVENANCE = {"date": "2026-01-01", "method": "ideal"}
DESCRIPTION = load_robot("minibiped")


def make_mapping(**offsets):
    data = {"robot": "minibiped", "provenance": PROVENANCE, "joint_offsets": offsets}
    return GainMapping(DESCRIPTION, RobotCalibration.model_validate(data))


def make_command(position=0.1, stiffness=18.9, damping=OWN_DAMPING, velocity=0.0, torque=0.0):
    values = (position, velocity, stiffness, damping, torque)
    return JointCommand(*(np.full(N, float(value)) for value in values))


def servo_torque(goals, frame, mapping, voltage=12.0):
    """What an unsaturated XM430-W350 makes of its registers, from the e-manual's control law."""
    motors = mapping.motor_parameters()
    present = 2048 + frame.joint_position * COUNTS_PER_RADIAN
    duty = goals.p_gain / 128 * (goals.position - present) / 885
    stall = motors.stall_torque(voltage)
    return duty * stall - motors.back_emf_damping() * frame.joint_velocity


# P = 800 -> 18.9 N·m/rad at 12 V and 22.1 at 14.8 V, back-EMF damping 0.851 (e-manual figures:
# 4.1 N·m, 46 rpm at 12 V; 128 register units a unit of P; duty 885 = 100 %).
def test_p_gain_800_is_18_9_newton_metres_a_radian():
    mapping = make_mapping()
    goals, applied = mapping.map(make_command(stiffness=18.876), SensorFrame.empty(N))
    assert goals.p_gain.tolist() == [800] * N
    np.testing.assert_allclose(applied.stiffness, 18.9, atol=0.05)
    np.testing.assert_allclose(mapping.motor_parameters().back_emf_damping(), 0.851, atol=1e-3)
    assert goals.d_gain.tolist() == [0] * N
    assert goals.pwm_limit.tolist() == [885] * N


def test_a_fuller_battery_needs_less_gain_for_the_same_stiffness():
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    mapping.map(make_command(), frame)
    frame.joint_voltage[:] = 14.8
    for _ in range(2000):
        frame.time_ns += 3_333_333
        goals, applied = mapping.map(make_command(), frame)
    assert mapping.voltage == pytest.approx(14.8, abs=0.05)
    np.testing.assert_allclose(applied.stiffness, 18.9, rtol=0.025)
    np.testing.assert_allclose(goals.p_gain, 650, rtol=0.025)


def test_the_gain_is_not_rewritten_for_every_tenth_of_a_volt():
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    before = mapping.map(make_command(), frame)[0].p_gain.copy()
    frame.joint_voltage[:] = 11.9
    for _ in range(1000):
        frame.time_ns += 3_333_333
        goals, _ = mapping.map(make_command(), frame)
    assert mapping.voltage == pytest.approx(11.9, abs=0.02)
    np.testing.assert_array_equal(goals.p_gain, before)


def test_unknown_voltages_mean_the_nominal_supply():
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    for _ in range(50):
        frame.time_ns += 3_333_333
        mapping.map(make_command(), frame)
    assert mapping.voltage == 12.0


# With k_d = k_free the general formula reduces to goal = q* + (τ + k_d·q̇*)/K.
def test_the_motors_own_damping_gives_the_plain_shift():
    mapping = make_mapping()
    own = float(mapping.motor_parameters().back_emf_damping()[0])
    command = make_command(damping=own, velocity=1.5, torque=1.0)
    goals, applied = mapping.map(command, SensorFrame.empty(N))
    expected = 0.1 + (1.0 + own * 1.5) / applied.stiffness
    np.testing.assert_allclose((goals.position - 2048) / COUNTS_PER_RADIAN, expected, atol=8e-4)
    np.testing.assert_allclose(applied.position, 0.1)


@given(
    position=st.floats(0.05, 0.4),
    velocity=st.floats(-1, 1),
    joint_velocity=st.floats(-1, 1),
    damping=st.floats(OWN_DAMPING + 0.001, 1.7),
    stiffness=st.floats(10, 40),
    torque=st.floats(-1, 1),
)
def test_the_servo_makes_the_torque_that_was_asked_for(
    position, velocity, joint_velocity, damping, stiffness, torque
):
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    frame.joint_position[:] = 0.2
    frame.joint_velocity[:] = joint_velocity
    command = make_command(position, stiffness, damping, velocity, torque)
    goals, applied = mapping.map(command, frame)
    made = servo_torque(goals, frame, mapping)
    asked = applied.stiffness * (position - 0.2) + damping * (velocity - joint_velocity) + torque
    half_count = 0.51 * applied.stiffness / COUNTS_PER_RADIAN
    assert np.all(np.abs(made - asked) <= half_count)
    realised = (
        applied.stiffness * (applied.position - 0.2)
        + applied.damping * (applied.velocity - joint_velocity)
        + applied.torque
    )
    np.testing.assert_allclose(made, realised, atol=1e-9)
    np.testing.assert_allclose(applied.stiffness, stiffness, rtol=0.01)


def test_limits_are_reported_by_joint():
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    command = make_command()
    command.position[KNEE] = 3.0
    command.torque[0] = 5.0
    command.damping[1] = 0.5
    command.stiffness[2] = 1e4
    _, applied = mapping.map(command, frame)
    flags = [Limit(int(value)) for value in applied.limit]
    assert Limit.POSITION in flags[KNEE]
    assert applied.position[KNEE] == 2.3
    assert flags[0] & Limit.TORQUE
    assert flags[1] == Limit.DAMPING
    assert applied.damping[1] == pytest.approx(OWN_DAMPING, abs=1e-3)
    assert Limit.STIFFNESS in flags[2]
    assert flags[4] == Limit.NONE


def test_saturation_begins_where_the_duty_reaches_100_percent():
    mapping, frame = make_mapping(), SensorFrame.empty(N)
    # e_sat = 128·885/(c·800) = 0.217 rad
    _, applied = mapping.map(make_command(position=0.21), frame)
    assert not applied.limit.any()
    _, applied = mapping.map(make_command(position=0.225), frame)
    assert (applied.limit == Limit.SATURATION).all()


def test_zero_stiffness_makes_no_torque():
    goals, applied = make_mapping().map(
        make_command(stiffness=0.0, torque=1.0), SensorFrame.empty(N)
    )
    assert not goals.p_gain.any()
    np.testing.assert_array_equal(applied.torque, 0.0)
    assert np.all((goals.position >= 0) & (goals.position <= 4095))


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_registers_stay_in_range_whatever_is_commanded(position, velocity, torque):
    goals, _ = make_mapping().map(
        make_command(position, velocity=velocity, torque=torque), SensorFrame.empty(N)
    )
    assert np.all((goals.position >= 0) & (goals.position <= 4095))
    assert np.all((goals.p_gain >= 0) & (goals.p_gain <= 16383))


def test_direction_and_offset_turn_a_joint_into_its_servo():
    joints = [
        joint.model_copy(update={"direction": -1}) if index == KNEE else joint
        for index, joint in enumerate(DESCRIPTION.joints)
    ]
    description = DESCRIPTION.model_copy(update={"joints": tuple(joints)})
    calibration = RobotCalibration.model_validate(
        {"robot": "minibiped", "provenance": PROVENANCE, "joint_offsets": {"left_knee": 0.2}}
    )
    goals, applied = GainMapping(description, calibration).map(
        make_command(position=0.5), SensorFrame.empty(N)
    )
    assert goals.position[KNEE] == 2048 - round(0.7 * COUNTS_PER_RADIAN)
    assert goals.position[0] == 2048 + round(0.5 * COUNTS_PER_RADIAN)
    assert applied.position[KNEE] == 0.5


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"damping": 0.4}, "left_knee: XM430-W350 cannot have damping 0.4.*feasible: 0.834 to"),
        ({"stiffness": 0.0}, "left_knee: XM430-W350 cannot have stiffness 0 .*feasible: 0.0236"),
        ({"servo": "XM999"}, "unknown servo model 'XM999'; valid: .*XM430-W350"),
        ({"range": (-4.0, 1.0)}, "left_knee: range .* leaves the servo's single turn"),
    ],
)
def test_what_a_servo_cannot_do_is_refused_at_once(change, message):
    joints = [
        joint.model_copy(update=change) if joint.name == "left_knee" else joint
        for joint in DESCRIPTION.joints
    ]
    description = DESCRIPTION.model_copy(update={"joints": tuple(joints)})
    with pytest.raises(InputError, match=message):
        GainMapping(
            description,
            RobotCalibration.model_validate({"robot": "minibiped", "provenance": PROVENANCE}),
        )
