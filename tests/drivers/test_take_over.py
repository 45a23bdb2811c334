"""A robot that a dead program left stiff is taken over where it stands."""

import numpy as np
import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel.control_table import WATCHDOG_TRIPPED, Register
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.robot import VirtualRobot

RATE = 300
DEAD_NS = 100_000_000
"""More than two watchdog units: every servo has stopped by itself."""


@pytest.fixture
def robot():
    description = load_robot("minibiped", ("plant.draws=null",))
    plant = Plant(description, RATE, 1, nominal_motors(description))
    virtual = VirtualRobot(description, plant, 1, RATE)
    virtual.start()
    yield virtual
    virtual.close()


def backend(robot):
    description = robot.description
    provenance = {"date": "2026-01-01", "method": "ideal"}
    calibration = RobotCalibration.model_validate(
        {"robot": "minibiped", "provenance": provenance, **robot.calibration_data}
    )
    mapping = GainMapping(description, calibration)
    return BusBackend(description, robot.clock, RATE, robot.port_urls, calibration, mapping)


def registers(robot, register):
    return [servo.registers[register] for servo in robot.servos.values()]


def test_stiff_servos_take_goals_again_without_a_jump(robot, monkeypatch):
    dead = backend(robot)
    dead.open()
    dead.arm()
    robot.clock.sleep_until_ns(robot.clock.now_ns() + DEAD_NS)
    assert registers(robot, Register.BUS_WATCHDOG) == [WATCHDOG_TRIPPED] * 12
    assert all(registers(robot, Register.TORQUE_ENABLE))
    monkeypatch.setattr(dead, "stop", lambda _: True)
    dead.close()  # as the kernel does for a program that is killed
    before = robot.world.joint_position.copy()

    heir = backend(robot)
    heir.open()
    heir.arm()
    assert registers(robot, Register.BUS_WATCHDOG) == [2] * 12
    np.testing.assert_allclose(robot.world.joint_position, before, atol=0.01)
    goals = registers(robot, Register.GOAL_POSITION)
    present = registers(robot, Register.PRESENT_POSITION)
    assert max(abs(a - b) for a, b in zip(goals, present, strict=True)) <= 3
    heir.close()
    assert not any(registers(robot, Register.TORQUE_ENABLE))
