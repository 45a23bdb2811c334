"""`stride calibrate` with a virtual robot's own hand: sound robots, and each that is not."""

import json

import numpy as np
import pytest

from drivers.boards.calibration import FootCalibration
from drivers.calibration import load_calibration
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.interface import CORNERS

RATE = 300


@pytest.fixture
def out(tmp_path):
    return tmp_path / "mine.yaml"


def refused(result, out, *sentences):
    assert result.exit_code == 1, result.output
    said = " ".join(result.stdout.replace("│", " ").split())
    for sentence in sentences:
        assert sentence in said, said
    assert "nothing was written" in said
    assert not out.exists()


# Joints --------------------------------------------------------------------------------------


def test_a_sound_joint_gets_its_offset_its_range_and_where_they_come_from(make_bench, out):
    bench = make_bench(miswire=["offset=left_knee,12"])
    result = bench.calibrate("joints", "--joint", "left_knee", "--out", out)
    assert result.exit_code == 0, result.output
    assert "so that the left foot moves backward" in result.stdout
    calibration = load_calibration(out)
    assert np.degrees(calibration.joint_offsets["left_knee"]) == pytest.approx(12.0, abs=0.2)
    assert calibration.joint_ranges == {"left_knee": (0.02, 2.3)}
    record = calibration.measured["joints"]
    assert record.parts == {"left_knee": "XM430-W350, left_leg id 4, firmware 48"}
    assert record.software.startswith("stridebridge ")


def test_zero_by_the_stops_is_the_same_zero(make_bench, out):
    bench = make_bench(miswire=["offset=right_ankle_roll,-7"])
    result = bench.calibrate(
        "joints", "--joint", "right_ankle_roll", "--zero", "stops", "--out", out
    )
    assert result.exit_code == 0, result.output
    offsets = load_calibration(out).joint_offsets
    assert np.degrees(offsets["right_ankle_roll"]) == pytest.approx(-7.0, abs=0.6)


@pytest.mark.parametrize(
    ("miswire", "joint", "sentence"),
    [
        ("mirror=left_knee", "left_knee", "turns the wrong way: moved as told"),
        ("offset=left_hip_yaw,50", "left_hip_yaw", "than 45°: its horn"),
        (
            "swap=left_hip_roll,left_ankle_roll",
            "left_ankle_roll",
            "it was moved, and left_hip_roll answered",
        ),
        ("swap=left_knee,right_knee", "left_knee", "it was moved, and right_knee answered"),
    ],
)
def test_a_joint_that_is_not_as_described_is_named(make_bench, out, miswire, joint, sentence):
    bench = make_bench(miswire=[miswire])
    result = bench.calibrate("joints", "--joint", joint, "--no-sweep", "--out", out)
    refused(result, out, joint, sentence)


def test_a_cable_that_is_too_short_is_told_and_the_driver_keeps_to_it(make_bench, out):
    bench = make_bench()
    model = bench.robot.world.model
    model.jnt_range[model.joint("left_hip_yaw").id] = -0.3, 0.8
    result = bench.calibrate("joints", "--joint", "left_hip_yaw", "--out", out)
    assert result.exit_code == 0, result.output
    assert "the robot file says -45.8° to 45.8°" in " ".join(result.stdout.split())
    calibration = load_calibration(out)
    assert calibration.joint_ranges["left_hip_yaw"] == pytest.approx((-0.3, 0.8), abs=0.05)
    low, high = calibration.ranges(bench.description)
    assert low[0] == calibration.joint_ranges["left_hip_yaw"][0]
    assert high[0] == 0.8


@pytest.mark.parametrize(
    ("register", "value", "sentence"),
    [
        (Register.TORQUE_ENABLE, 1, "torque is on: stride relax first"),
        (Register.HOMING_OFFSET, 100, "Homing Offset is 100, must be 0"),
    ],
)
def test_a_servo_that_is_not_limp_and_plain_is_refused(bench, out, register, value, sentence):
    bench.registers("left_knee")[register] = value
    refused(bench.calibrate("joints", "--out", out), out, "left_knee", sentence)


def test_without_a_file_to_write_the_error_says_how_to_name_one(bench):
    result = bench.calibrate("joints")
    assert result.exit_code == 2
    assert "calibration: is missing" in result.stderr
    assert "--out FILE.yaml" in result.stderr


def test_input_that_ends_is_an_error_and_nothing_is_written(bench, out):
    result = bench.stride("calibrate", "joints", "minibiped", *bench.ports(), "--out", out)
    assert result.exit_code == 2
    assert "standard input ended" in result.stderr
    assert not out.exists()


# IMU -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("turned", ["90,0,0", "3,-4,180"])
def test_the_mounting_of_an_imu_is_found_however_it_sits(make_bench, out, turned):
    bench = make_bench(miswire=[f"imu={turned}"])
    result = bench.calibrate("imu", "--out", out)
    assert result.exit_code == 0, result.output
    frame = _frame(bench, out)
    truth = bench.robot.world.truth()
    assert _apart_deg(frame.imu_orientation, truth.base_orientation) < 1.5
    assert np.linalg.norm(frame.imu_linear_acceleration - [0, 0, 9.81]) < 0.5


def test_an_imu_that_is_upside_down_is_refused_unless_it_is_said(make_bench, out):
    bench = make_bench(miswire=["imu=180,0,0"])
    refused(bench.calibrate("imu", "--out", out), out, "is upside down: at rest its z axis points")
    result = bench.calibrate("imu", "--out", out, "--upside-down")
    assert result.exit_code == 0, result.output
    mounting = load_calibration(out).imu.mounting
    assert np.abs(mounting) == pytest.approx([0, 1, 0, 0], abs=0.01)


# Feet ----------------------------------------------------------------------------------------


def test_cells_get_their_zeros_and_scales_and_weigh_the_robot(bench, out):
    result = bench.calibrate("feet", "--out", out)
    assert result.exit_code == 0, result.output
    assert "the robot weighs 25." in result.stdout
    calibration = load_calibration(out)
    for side, true in bench.robot.calibration_data["feet"].items():
        found = calibration.feet[side]
        assert found.scale == pytest.approx(true["scale"], rel=0.02)
        zero_n = (np.array(found.zero) - true["zero"]) * true["scale"]
        assert np.abs(zero_n).max() < 0.3
    assert calibration.measured["feet"].residual < 0.1


@pytest.mark.parametrize(
    ("overrides", "miswire", "options", "sentence"),
    [
        (
            (), ["cells=left_foot,front_left,rear_left"], (),
            "left foot cell front_left was loaded, and rear_left answered",
        ),
        ((), ["swap=left_foot,right_foot"], (), "was loaded, and the right foot answered"),
        (
            ("plant.dead_cells=[left_foot:rear_right]",), [], (),
            "cell rear_right does not answer to load",
        ),
        ((), [], ("--mass", "3.2"), "N, its mass says 31.4 N"),
    ],
)  # fmt: skip
def test_cells_that_cannot_be_right_are_named(make_bench, out, overrides, miswire, options,
                                              sentence):  # fmt: skip
    bench = make_bench(*overrides, miswire=miswire)
    refused(bench.calibrate("feet", "--out", out, *options), out, sentence)


# Leaning -------------------------------------------------------------------------------------


def test_a_robot_whose_parts_agree_is_on_record(calibrated):
    bench = calibrated()
    path = bench.path
    result = bench.calibrate("lean", file=bench.file)
    assert result.exit_code == 0, result.output
    calibration = load_calibration(path)
    assert calibration.agreed == calibration.identity()


@pytest.mark.parametrize(
    ("miswire", "sentences"),
    [
        ("mirror=left_hip_roll", ["left_hip_roll leaning left", "turns the wrong way"]),
        ("imu=0,0,180", ["imu leaning left: says right", "imu leaning forward: says backward"]),
        ("imu=0,0,90", ["imu leaning left: says forward"]),
        ("swap=left_foot,right_foot", ["cells weigh the robot as", "feet exchanged"]),
    ],
)
def test_a_part_that_disagrees_is_named(calibrated, miswire, sentences):
    bench = calibrated(miswire=[miswire])
    before = bench.path.read_text()
    result = bench.calibrate("lean", file=bench.file)
    assert result.exit_code == 1, result.output
    said = " ".join(result.stdout.replace("│", " ").split())
    for sentence in sentences:
        assert sentence in said, said
    assert bench.path.read_text() == before


def test_leaning_needs_cells_that_are_calibrated(bench, out):
    bench.calibrate("imu", "--out", out)
    result = bench.calibrate("lean", "--out", out)
    assert result.exit_code == 2
    assert "measured: not yet: joint left_hip_yaw" in result.stderr
    assert "left foot, right foot" in result.stderr


# All of it, and what the driver makes of it --------------------------------------------------


def _frame(bench, path):
    """What the driver measures with a calibration, robot at rest."""
    calibration = load_calibration(path)
    feet = {side: _plain_foot() for side in ("left", "right")} if not calibration.feet else {}
    # The driver refuses a robot that is measured in part; here only the part is looked at.
    whole = {"feet": {**feet, **calibration.feet}, "measured": {}}
    calibration = calibration.model_copy(update=whole)
    backend = BusBackend(
        bench.description, bench.robot.clock, RATE, bench.robot.port_urls, calibration,
        GainMapping(bench.description, calibration),
    )  # fmt: skip
    for bus_registers in bench.robot.servos.values():
        bus_registers.registers[Register.RETURN_DELAY_TIME] = 0
    try:
        backend.open()
        for _ in range(5):
            bench.robot.clock.sleep_until_ns(bench.robot.clock.now_ns() + 1_000_000_000 // RATE)
            frame = backend.read()
        return frame
    finally:
        backend.close()


def _plain_foot():
    return FootCalibration(zero=(0.0,) * 4, scale=(1.0,) * 4)


def _apart_deg(a, b):
    return np.degrees(2 * np.arccos(min(1.0, abs(float(np.dot(a, b))))))


def test_a_calibrated_driver_sees_a_crooked_robot_as_it_is(make_bench, out):
    """Offsets, cells and a turned IMU: the frame is the truth again."""
    bench = make_bench(miswire=["offset=left_knee,12", "offset=right_hip_roll,-20", "imu=0,0,-90"])
    for command in (("joints", "--no-sweep"), ("imu",), ("feet",), ("lean",)):
        result = bench.calibrate(*command, "--out", out)
        assert result.exit_code == 0, result.output
    frame, truth = _frame(bench, out), bench.robot.world.truth()
    assert np.degrees(frame.joint_position - truth.joint_position) == pytest.approx(0.0, abs=0.3)
    assert _apart_deg(frame.imu_orientation, truth.base_orientation) < 1.5
    assert frame.foot_force == pytest.approx(truth.foot_force, abs=1.5)
    assert frame.foot_force.shape == (2, len(CORNERS))
    assert set(load_calibration(out).measured) == {"joints", "imu", "feet", "lean"}
    assert json.dumps(load_calibration(out).model_dump(mode="json"))
