"""The gyro's bias before arming: found at rest, left alone when the torso moves."""

import numpy as np
import pytest

from drivers.boards.frames import ImuFrame
from drivers.boards.gyro_rest import bias_at_rest
from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.robot import VirtualRobot

GYRO = np.radians(2000 / 32768)


def frames(count, bias=(0.01, -0.02, 0.005), noise=0.02, turn=0.0, status=7):
    """A sensor with a bias, turning by so much about its z axis meanwhile [rad]."""
    random = np.random.default_rng(1)
    for i in range(count):
        angle = turn * i / count
        orientation = (round(16384 * np.cos(angle / 2)), 0, 0, round(16384 * np.sin(angle / 2)))
        rates = np.rint((np.array(bias) + noise * random.standard_normal(3)) / GYRO)
        yield ImuFrame(i, 1667 * i, status, orientation, tuple(rates.astype(int)), (0, 0, 4096))


def test_the_bias_of_a_gyro_at_rest_is_found():
    assert bias_at_rest(list(frames(600))) == pytest.approx((0.01, -0.02, 0.005), abs=0.003)


@pytest.mark.parametrize(
    "moving",
    [
        {"noise": 0.2},
        {"bias": (0.2, 0.0, 0.0)},
        {"bias": (0.0, 0.0, 0.03), "turn": 0.03},
        {"status": 3},
    ],
)
def test_a_gyro_that_is_not_at_rest_keeps_its_bias(moving):
    assert bias_at_rest(list(frames(600, **moving))) is None
    assert bias_at_rest(list(frames(20))) is None


class NoGuardian:
    """In the guardian's place: a virtual clock has one process."""

    def __init__(self, switch_off):
        pass


@pytest.mark.parametrize(("held", "renewed"), [(True, True), (False, False)])
def test_a_driver_in_real_time_renews_it_when_it_opens(monkeypatch, held, renewed):
    monkeypatch.setattr("drivers.robot_backend.Guardian", NoGuardian)
    description = load_robot(
        "minibiped", ("plant.draws=null", "noise.gyro_bias=0.03", "noise.gyro=0.002")
    )
    plant = Plant(description, 300, 0, nominal_motors(description))
    robot = VirtualRobot(description, plant, 0, 300)
    robot.start()
    if not held:
        plant.set_support(False)  # limp, and falling
    content = {"robot": "minibiped", "provenance": {"date": "2026-01-02", "method": "ideal"}}
    own = RobotCalibration.model_validate({**content, **robot.calibration_data})
    backend = BusBackend(
        description, robot.clock, 300, robot.port_urls, own, GainMapping(description, own),
        guarded=True,
    )  # fmt: skip
    try:
        backend.open()
        told = any("its gyro keeps the calibrated bias" in one for one in backend.changes)
        assert told is not renewed
        if renewed:
            converted = np.zeros(4), np.zeros(3), np.zeros(3)
            sensor = backend._boards._imu
            sensor.converter.convert(sensor.reader.latest, *converted)
            assert np.abs(converted[1]).max() < 0.008  # hidden: 0.03 rad/s a standard deviation
    finally:
        robot.close()
