"""Boards on their lines: rates, raw counts and what calibration makes of them, device clocks."""

import mujoco
import numpy as np
import pytest
import serial

from drivers.boards.frames import ACCELERATION_UNIT, GYRO_UNIT, ORIENTATION_UNIT, FrameReader
from tests.sim_backends.conftest import hold

NOISELESS = (
    *("noise.attitude=0", "noise.attitude_bias=0", "noise.gyro=0", "noise.gyro_bias=0"),
    *("noise.accelerometer=0", "noise.corner_force=0", "noise.corner_zero=0"),
    *("noise.board_jitter_us=0", "noise.usb_jitter_us=0"),
)


def standing(made):
    hold(made.world)
    made.world.set_support(False)
    made.clock.sleep_until_ns(1_000_000_000)
    return made


def listen(made, name, seconds=0.1):
    """Frames of a board, with their arrival times."""
    port = serial.serial_for_url(made.port_urls[name], baudrate=921600, timeout=0)
    end = made.clock.now_ns() + int(seconds * 1e9)
    reader, frames = FrameReader(), []
    while made.clock.now_ns() < end:
        made.clock.wait_readable([port], end)
        now = made.clock.now_ns()
        frames += [(now, frame) for frame in reader.feed(port.read(port.in_waiting))]
    assert reader.crc_errors == 0
    return frames


@pytest.mark.parametrize(("rate", "expected"), [(300, 600.0), (225, 562.5)])
def test_frames_come_at_the_grid_rate_nearest_to_the_board_s(robot, rate, expected):
    frames = listen(robot(rate=rate), "left_foot", 0.4)
    times = [arrival for arrival, _ in frames]
    assert (len(times) - 1) / (times[-1] - times[0]) * 1e9 == pytest.approx(expected, rel=0.01)
    sequence = [frame.sequence for _, frame in frames]
    assert np.diff(sequence).tolist() == [1] * (len(sequence) - 1)


def test_a_board_holds_its_frames_back_for_the_delay_that_the_robot_file_tells(robot):
    """The foot board's filter takes 820 us (docs/foot-board.md)."""
    arrivals = {}
    for delay_us in (0, 820):
        made = robot(*NOISELESS, delay_us=delay_us)
        arrivals[delay_us] = [arrival for arrival, _ in listen(made, "left_foot", 0.05)][:20]
    late = np.array(arrivals[820]) - np.array(arrivals[0])
    assert set(late.tolist()) == {820_000}


def test_calibrated_counts_are_the_corner_forces(robot):
    made = standing(robot(*NOISELESS))
    for foot, side in enumerate(("left", "right")):
        _, frame = listen(made, f"{side}_foot", 0.02)[-1]
        calibration = made.calibration_data["feet"][side]
        force = np.array(calibration["scale"]) * (frame.counts - np.array(calibration["zero"]))
        np.testing.assert_allclose(force, made.world.truth().foot_force[foot], atol=0.02)
        assert frame.status == 0b1111


def test_eight_calibrated_cells_carry_the_weight(robot):
    made = standing(robot())
    total = 0.0
    for side in ("left", "right"):
        calibration = made.calibration_data["feet"][side]
        counts = np.mean([frame.counts for _, frame in listen(made, f"{side}_foot", 0.2)], axis=0)
        total += (np.array(calibration["scale"]) * (counts - calibration["zero"])).sum()
    weight = made.world.model.body_mass.sum() * 9.81
    assert total == pytest.approx(weight, rel=0.03)


def test_raw_counts_mean_nothing_without_calibration(robot):
    zeros = np.array([robot(seed=seed).calibration_data["feet"]["left"]["zero"] for seed in (0, 1)])
    scales = np.array(
        [robot(seed=seed).calibration_data["feet"]["left"]["scale"] for seed in range(4)]
    )
    assert np.abs(zeros).mean() > 10_000
    assert not np.allclose(zeros[0], zeros[1])
    assert (scales > 0).any()
    assert (scales < 0).any()


def test_an_imu_at_rest_feels_gravity_upwards(robot):
    made = standing(robot(*NOISELESS))
    _, frame = listen(made, "imu", 0.02)[-1]
    orientation = np.array(frame.orientation) * ORIENTATION_UNIT
    np.testing.assert_allclose(orientation, made.world.truth().base_orientation, atol=1e-3)
    np.testing.assert_allclose(np.array(frame.gyro) * GYRO_UNIT, 0.0, atol=0.01)
    acceleration = np.array(frame.acceleration) * ACCELERATION_UNIT
    upwards = np.empty(3)
    mujoco.mju_rotVecQuat(upwards, np.array([0.0, 0.0, 9.81]), orientation * [1, -1, -1, -1])
    np.testing.assert_allclose(acceleration, upwards, atol=0.02)


def test_imu_frames_are_as_old_as_the_robot_says(robot):
    """Stamped when sampled, sent imu_delay later, then bytes on the wire and one transfer."""
    made = robot(*NOISELESS)
    frames = listen(made, "imu", 0.5)
    arrivals = np.array([arrival for arrival, _ in frames])
    grid = np.array([made.world.grid_time_ns(i) for i in range(700)])
    ages = arrivals - grid[np.searchsorted(grid, arrivals - 2_000_000) - 1]
    wire_ns = 34 * 10 * 1_000_000_000 // 921_600
    assert np.ptp(ages) <= 1
    assert ages[0] == pytest.approx(2_000_000 + wire_ns + 125_000, abs=1)


def test_board_clocks_drift_but_little(robot):
    frames = listen(robot(*NOISELESS), "imu", 1.0)
    (first, a), (last, b) = frames[0], frames[-1]
    elapsed_us = (b.device_time_us - a.device_time_us) % (1 << 32)
    drift = elapsed_us / ((last - first) / 1000) - 1
    assert 0 < abs(drift) < 60e-6


def test_a_seed_repeats_the_noise_and_another_does_not(robot):
    bytes_of = {}
    for run, seed in enumerate((3, 3, 4)):
        bytes_of[run] = [frame for _, frame in listen(robot(seed=seed), "imu", 0.1)]
    assert bytes_of[0] == bytes_of[1]
    assert bytes_of[0] != bytes_of[2]
