"""Boards in time: device clocks, readers, calibration files."""

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from drivers.boards.calibration import (
    FootCalibration,
    FootConverter,
    ImuCalibration,
    ImuConverter,
)
from drivers.boards.device_clock import DeviceClock
from drivers.boards.frames import (
    CELL_RAIL,
    FootFrame,
    FrameReader,
    encode_foot_frame,
    encode_imu_frame,
)
from drivers.boards.reader import BoardReader
from drivers.boards.sensors import FootSensor
from drivers.calibration import load_calibration, save_calibration
from hil.errors import DescriptionError, InputError
from hil.interface import NEVER_NS, SensorFrame
from hil.robot_files import load_robot

PERIOD_US = 1667
LEAST_NS = 450_000


class Line:
    """A port with bytes in it."""

    def __init__(self):
        self.waiting = b""

    def read_available(self):
        data, self.waiting = self.waiting, b""
        return data


def feed(clock, delays_us, start_us, drift=0.0):
    """Errors of the mapped sample times [ns] of frames that arrive late by `delays_us`."""
    errors = []
    for k, delay_us in enumerate(delays_us):
        sampled_ns = k * PERIOD_US * 1000
        device_us = int(start_us + k * PERIOD_US * (1 + drift)) % 2**32
        arrived_ns = sampled_ns + LEAST_NS + delay_us * 1000
        errors.append(clock.to_host_ns(device_us, arrived_ns) - sampled_ns)
    return errors


@given(st.lists(st.integers(0, 3000), min_size=60, max_size=80), st.integers(0, 2**32 - 1))
def test_jitter_is_filtered_and_the_wrap_is_invisible(delays, start_us):
    delays[5] = 0
    errors = feed(DeviceClock(LEAST_NS), delays, start_us)
    assert max(map(abs, errors[5:])) < 100_000


@pytest.mark.parametrize("drift", [-50e-6, 50e-6])
def test_a_drifting_crystal_is_followed(drift):
    rng = np.random.default_rng(1)
    delays = rng.integers(0, 1000, 60_000).tolist()  # 100 s: 5 ms of drift
    errors = feed(DeviceClock(LEAST_NS), delays, 0, drift)
    assert np.max(np.abs(errors[-1000:])) < 200_000


def test_a_restarted_board_starts_a_new_time():
    clock = DeviceClock(LEAST_NS)
    feed(clock, [100] * 50, start_us=90_000_000)
    now_ns = 3_000_000_000
    assert clock.to_host_ns(1_000, now_ns) == now_ns - LEAST_NS
    assert clock.resets == 1


def test_a_sample_is_never_in_the_future():
    clock = DeviceClock(0)
    assert all(
        clock.to_host_ns(k * PERIOD_US + lead, k * PERIOD_US * 1000) <= k * PERIOD_US * 1000
        for k, lead in enumerate([0, 500, 0, 900, 0])
    )


def test_the_reader_holds_the_latest_frame_and_lets_it_age():
    line = Line()
    reader = BoardReader(line, LEAST_NS, period_ns=1_667_000, tick_ns=3_333_333)
    assert not reader.poll(0)
    assert reader.age_ns(0) == NEVER_NS
    assert not reader.is_fresh(0)
    for k in range(3):
        line.waiting += encode_foot_frame(k, k * PERIOD_US, 15, (k, k, k, k))
    now_ns = 2 * PERIOD_US * 1000 + LEAST_NS
    assert reader.poll(now_ns)
    assert reader.latest == FootFrame(2, 2 * PERIOD_US, 15, (2, 2, 2, 2))
    assert reader.age_ns(now_ns) == LEAST_NS
    assert reader.is_fresh(now_ns + 5_000_000)
    assert not reader.is_fresh(now_ns + 10_000_000)
    assert not reader.poll(now_ns + 10_000_000)


def test_force_is_scale_times_counts_above_zero_and_invalid_cells_keep_theirs():
    converter = FootConverter(FootCalibration(zero=(1e5, 0, 0, 0), scale=(5e-4, -5e-4, 1, 1)))
    force = np.array([0.0, 0.0, 7.0, 0.0])
    converter.convert(FootFrame(0, 0, 0b1011, (102_000, -2_000, 5, 5)), force)
    np.testing.assert_allclose(force, [1.0, 1.0, 7.0, 5.0])


def test_a_mounted_imu_reads_in_base_axes():
    # The sensor's x axis points along base y: a quarter turn about z.
    half = np.sqrt(0.5)
    converter = ImuConverter(ImuCalibration(mounting=(half, 0, 0, half)))
    (frame,) = FrameReader().feed(
        encode_imu_frame(0, 0, 7, (11585, 0, 0, 11585), (16384, 0, 0), (0, 0, 4096))
    )
    orientation, gyro, acceleration = np.zeros(4), np.zeros(3), np.zeros(3)
    converter.convert(frame, orientation, gyro, acceleration)
    np.testing.assert_allclose(orientation, [1, 0, 0, 0], atol=1e-4)
    np.testing.assert_allclose(gyro, [0, np.deg2rad(1000), 0], atol=1e-9)
    np.testing.assert_allclose(acceleration, [0, 0, 9.80665], atol=1e-9)


def test_calibration_survives_its_file(tmp_path, calibration):
    path = tmp_path / "minibiped.yaml"
    save_calibration(calibration, path)
    assert load_calibration(path) == calibration
    calibration.check_against(load_robot("minibiped"))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"feet": {"left": {"zero": [0, 0, 0], "scale": [1] * 4}}}, "feet.left.zero"),
        ({"feet": {"left": {"zero": [0] * 4, "scale": [1, 0, 1, 1]}}}, "scale must not be 0"),
        ({"imu": {"mounting": [2, 0, 0, 0]}}, "unit quaternion"),
        ({"offsets": {}}, "unknown key; valid here: .*joint_offsets"),
        ({"provenance": {}}, "provenance.date: is missing"),
    ],
)
def test_a_wrong_calibration_file_is_named_with_its_key(tmp_path, calibration, change, message):
    path = tmp_path / "wrong.yaml"
    path.write_text(yaml.safe_dump({**calibration.model_dump(mode="json"), **change}))
    with pytest.raises(DescriptionError, match=rf"wrong\.yaml: .*{message}"):
        load_calibration(path)


def test_a_calibration_of_another_robot_is_refused(calibration):
    description = load_robot("minibiped")
    for change, message in (
        ({"robot": "other"}, "is for 'other'"),
        ({"joint_offsets": {"left_elbow": 0.1}}, "no joint left_elbow; valid: .*left_knee"),
        ({"feet": {}}, "feet.left: is missing"),
    ):
        with pytest.raises(DescriptionError, match=message):
            calibration.model_copy(update=change).check_against(description, "robot.yaml")


def test_a_missing_calibration_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.yaml: cannot be read"):
        load_calibration(tmp_path / "none.yaml")


def frames_in_time(reader, line, counts):
    """Ages after one new frame a tick, of these counts."""
    ages_ns = []
    for k, cells in enumerate(counts):
        now_ns = k * 3_333_000 + LEAST_NS
        line.waiting += encode_foot_frame(k, k * 3_333, 15, cells)
        assert reader.poll(now_ns)
        ages_ns.append(reader.age_ns(now_ns))
    return ages_ns


@pytest.mark.parametrize("noisy", [True, False])
def test_a_board_whose_values_stand_still_is_not_believed(noisy):
    line = Line()
    reader = BoardReader(line, LEAST_NS, 1_667_000, 3_333_333, noisy)
    moving = [(k, 0, 0, 0) for k in range(10)]
    ages_ns = frames_in_time(reader, line, moving + [moving[-1]] * 20)
    assert max(ages_ns[:14]) == LEAST_NS
    assert reader.is_fresh(29 * 3_333_000 + LEAST_NS) == (not noisy)
    assert ages_ns[-1] == (LEAST_NS + 16 * 3_333_000 if noisy else LEAST_NS)
    assert frames_in_time(reader, line, [(30, 0, 0, 0)]) == [LEAST_NS]


@pytest.mark.parametrize("jump_us", [-2_000_000, -3_000, 3_000, 400_000, 2_000_000])
def test_a_jump_of_the_boards_clock_costs_no_age(jump_us):
    line = Line()
    reader = BoardReader(line, LEAST_NS, 1_667_000, 3_333_333)
    for k in range(200):
        now_ns = k * 1_667_000 + LEAST_NS
        jump = jump_us if k >= 100 else 0
        line.waiting += encode_foot_frame(k, 5_000_000 + k * 1_667 + jump, 15, (k, k, k, k))
        reader.poll(now_ns)
        assert reader.age_ns(now_ns) == pytest.approx(LEAST_NS, abs=50_000)


def test_a_cell_at_the_end_of_its_converter_is_invalid_whatever_its_board_says():
    line = Line()
    reader = BoardReader(line, LEAST_NS, 1_667_000, 3_333_333)
    converter = FootConverter(FootCalibration(zero=(0.0,) * 4, scale=(0.001,) * 4))
    foot, frame = FootSensor(reader, converter), SensorFrame.empty(1)
    line.waiting += encode_foot_frame(0, 0, 15, (1000, 2000, CELL_RAIL, -CELL_RAIL - 1))
    foot.read(1, LEAST_NS, frame)
    assert frame.foot_valid[1].tolist() == [True, True, False, False]
    assert frame.foot_force[1].tolist() == [1.0, 2.0, 0.0, 0.0]
