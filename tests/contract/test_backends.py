"""What the loop may rely on, whichever backend it has (hil.interface.Backend)."""

import dataclasses

import numpy as np
import pytest

from hil.errors import BackendError, InvalidCommandError
from hil.interface import NEVER_NS, AppliedCommand, Limit, SensorFrame, StopMode
from hil.servo import COUNTS_PER_RADIAN

REPORT_KEYS = {
    "bus_utilisation_pct", "bus_crc_errors", "bus_timeouts", "bus_stale_frames",
    "temperature_max_c", "voltage_min_v", "duty_saturation_pct_max",
}  # fmt: skip
KNEE = 3


def heard(rig):
    """A frame with everything valid: on a busy machine a tick may miss an answer."""
    for _ in range(rig.rate):
        frame = rig.tick()
        imu = frame.imu_valid or not frame.imu_present
        if frame.joint_valid.all() and frame.foot_valid.all() and imu:
            return frame
    raise AssertionError(f"never complete: {frame}")


def test_frames_have_the_shapes_of_the_contract(opened):
    frame = heard(opened)
    empty = SensorFrame.empty(opened.n)
    for field in dataclasses.fields(SensorFrame):
        value, model = getattr(frame, field.name), getattr(empty, field.name)
        if isinstance(model, np.ndarray):
            assert value.shape == model.shape, field.name
            assert value.dtype == model.dtype, field.name
    assert frame.imu_present == (opened.description.imu is not None)


def test_values_are_finite_and_physical(opened):
    frame = heard(opened)
    for values in (frame.joint_position, frame.joint_velocity, frame.joint_torque):
        assert np.isfinite(values).all()
    if frame.imu_present:
        assert np.linalg.norm(frame.imu_orientation) == pytest.approx(1.0, abs=1e-3)
    if opened.is_servo:
        assert frame.joint_voltage == pytest.approx(12.0, abs=0.5)
        assert frame.joint_temperature == pytest.approx(25.0, abs=2)
        np.testing.assert_allclose(
            frame.joint_position, opened.description.start_position, atol=0.1
        )
    assert (frame.joint_error == 0).all()


def test_ages_and_time_stamps_are_of_the_tick(opened):
    before = opened.backend.clock.now_ns()
    frame = heard(opened)
    assert before <= frame.time_ns <= opened.backend.clock.now_ns()
    ages = np.concatenate([frame.joint_age_ns, frame.foot_age_ns])
    assert (ages >= 0).all()
    assert (ages < 50_000_000).all()
    if frame.imu_present:
        assert 0 <= frame.imu_age_ns < 50_000_000
    assert (ages != NEVER_NS).all()


def test_the_frame_is_reused_and_time_moves_on(opened):
    frame = opened.tick()
    first = frame.time_ns
    assert opened.tick() is frame
    assert frame.time_ns > first


def test_after_close_nothing_is_read(rig):
    rig.backend.open()
    rig.backend.close()
    with pytest.raises(BackendError):
        rig.backend.read()


def test_close_may_be_called_twice_and_before_open(rig):
    rig.backend.close()
    rig.backend.open()
    rig.backend.close()
    rig.backend.close()


def test_a_command_that_is_not_finite_is_refused_by_name(opened):
    for field in ("position", "velocity", "stiffness", "damping", "torque"):
        for value in (np.nan, np.inf, -np.inf):
            command = opened.hold()
            getattr(command, field)[2] = value
            with pytest.raises(InvalidCommandError, match=opened.description.joint_names[2]):
                opened.backend.write(command)


def test_a_command_of_the_wrong_size_is_refused(opened):
    command = opened.hold()
    command.torque = np.zeros(opened.n - 1)
    with pytest.raises(InvalidCommandError, match="shape"):
        opened.backend.write(command)


def test_a_refused_command_changes_nothing(armed):
    armed.run(0.2, armed.hold())
    before = heard(armed).joint_position.copy()
    command = armed.hold(np.asarray(armed.description.start_position) + 0.3)
    command.velocity[0] = np.nan
    with pytest.raises(InvalidCommandError):
        armed.backend.write(command)
    np.testing.assert_allclose(armed.run(0.1).joint_position, before, atol=0.01)


def test_before_arming_a_command_is_held_back(opened):
    before = heard(opened).joint_position.copy()
    command = opened.hold(before + 0.3 if opened.is_servo else None)
    command.torque[:] = 1.0
    for _ in range(10):
        opened.tick(command)
        assert (opened.applied.limit & int(Limit.HELD)).all()
    if opened.is_servo:
        np.testing.assert_allclose(opened.tick().joint_position, before, atol=0.1)


def test_arming_adopts_the_present_position_without_a_jerk(armed):
    before = heard(armed).joint_position.copy()
    for _ in range(armed.rate // 5):
        frame = armed.tick()
        np.testing.assert_allclose(frame.joint_position, before, atol=0.05)
        assert np.abs(frame.joint_velocity).max() < 0.5


def test_a_command_moves_the_joint_it_names_and_reads_show_it(armed):
    armed.run(0.3, armed.hold())
    before = heard(armed).joint_position.copy()
    goal = np.asarray(armed.description.start_position).copy()
    goal[KNEE] += 0.2
    armed.run(0.5, armed.hold(goal))
    moved = heard(armed).joint_position - before
    assert moved[KNEE] == pytest.approx(0.2, abs=0.05)
    others = np.delete(moved, KNEE)
    assert np.abs(others).max() < 0.05
    assert isinstance(armed.applied, AppliedCommand)
    assert armed.applied.position[KNEE] == pytest.approx(goal[KNEE])


def test_a_position_beyond_the_range_is_clamped_and_says_so(armed):
    goal = np.asarray(armed.description.start_position).copy()
    goal[KNEE] = 9.0
    armed.tick(armed.hold(goal))
    assert armed.applied.limit[KNEE] & int(Limit.POSITION)
    assert armed.applied.position[KNEE] <= armed.description.joints[KNEE].range[1] + 1e-9
    assert not armed.applied.limit[0] & int(Limit.POSITION)


def test_torque_off_is_verified_and_the_joints_go_limp(armed):
    armed.run(0.2, armed.hold())
    assert armed.backend.stop(StopMode.TORQUE_OFF) is True
    armed.begin()
    frame = armed.run(0.1, armed.hold())
    assert (armed.applied.limit & int(Limit.HELD)).all()
    assert np.abs(heard(armed).joint_torque).max() < 0.02
    assert frame is heard(armed)


def test_a_soft_stop_holds_the_last_goal(armed):
    armed.run(0.3, armed.hold())
    before = heard(armed).joint_position.copy()
    assert armed.backend.stop(StopMode.SOFT) is True
    armed.begin()
    command = armed.hold(np.asarray(armed.description.start_position) + 0.3)
    frame = armed.run(0.2, command)
    np.testing.assert_allclose(frame.joint_position, before, atol=0.03)
    assert np.abs(frame.joint_torque).max() > 0.02


def test_it_can_be_armed_again_after_a_stop(armed):
    armed.run(0.1, armed.hold())
    armed.backend.stop(StopMode.TORQUE_OFF)
    armed.backend.arm()
    armed.begin()
    armed.run(0.1, armed.hold())
    assert not (armed.applied.limit & int(Limit.HELD)).any()


def test_torques_move_a_torque_robot_at_once_and_no_further_than_the_limit(torque_rig):
    rig = torque_rig
    rig.backend.open()
    rig.backend.arm()
    rig.begin()
    command = rig.hold()
    elbow = rig.description.joint_names.index("left_elbow")
    before = rig.tick().joint_position[elbow]
    command.torque[elbow] = 1e6
    rig.tick(command)
    assert rig.applied.limit[elbow] & int(Limit.TORQUE)
    assert rig.applied.torque[elbow] == rig.description.joints[elbow].torque_limit
    frame = rig.tick()
    assert frame.joint_position[elbow] > before
    assert frame.joint_torque[elbow] == rig.applied.torque[elbow]


def test_frames_hold_measurements_not_the_truth(armed):
    """Counts, register units and noise: nothing of a servo robot's frame is exact."""
    armed.run(0.3, armed.hold())
    frame = heard(armed)
    truth = armed.world.truth()
    counts = frame.joint_position * COUNTS_PER_RADIAN
    np.testing.assert_allclose(counts, np.rint(counts), atol=1e-6)
    assert (frame.joint_position != truth.joint_position).any()
    assert (frame.foot_force != truth.foot_force).all()
    for field in dataclasses.fields(SensorFrame):
        value = getattr(frame, field.name)
        if isinstance(value, np.ndarray):
            for other in dataclasses.fields(truth):
                known = getattr(truth, other.name)
                assert not np.shares_memory(value, known) if other.name != "time_ns" else True


def test_eight_cells_carry_the_weight_of_the_standing_robot(armed):
    armed.run(0.5, armed.hold())
    armed.world.set_support(False)
    armed.run(0.5, armed.hold())
    total = np.mean([armed.tick(armed.hold()).foot_force.sum() for _ in range(25)])
    assert total == pytest.approx(2.62 * 9.81, rel=0.03)


def test_statistics_have_the_keys_of_the_report(opened):
    statistics = opened.backend.statistics()
    assert set(statistics) >= REPORT_KEYS
    assert all(value is None or np.isfinite(value) for value in statistics.values())
    if opened.backend.name == "mujoco":
        assert statistics["bus_utilisation_pct"] is None
