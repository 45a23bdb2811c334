"""The backend without wires: its delays are those that the wires would make, its draws seeded."""

import numpy as np
import pytest

from drivers.calibration import Provenance, RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.clock import tick_time_ns
from hil.errors import InputError
from hil.interface import JointCommand
from sim_backends.latency import command_latency_ns, read_time_ns
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant
from sim_backends.virtual.robot import VirtualRobot

RATE = 300
TICKS = 150


def calibration(description, data=None):
    provenance = Provenance(date="2026-01-01", method="ideal")
    return RobotCalibration(robot=description.name, provenance=provenance, **(data or {}))


def direct(description, seed=0):
    mapping = GainMapping(description, calibration(description))
    plant = Plant(description, RATE, seed, mapping.motor_parameters())
    return MujocoBackend(description, plant, mapping, RATE, seed), plant


def wired(description, seed=0):
    nominal = GainMapping(description, calibration(description))
    plant = Plant(description, RATE, seed, nominal.motor_parameters())
    robot = VirtualRobot(description, plant, seed, RATE)
    robot.start()
    ideal = calibration(description, robot.calibration_data)
    mapping = GainMapping(description, ideal)
    return BusBackend(description, robot.clock, RATE, robot.port_urls, ideal, mapping), plant


def sway(description, backend, ticks=TICKS):
    """Swing all joints together; joint positions of every tick, and the ages seen."""
    backend.open()
    backend.read()
    backend.arm()
    command = JointCommand.zeros(12)
    command.stiffness[:] = [joint.stiffness for joint in description.joints]
    command.damping[:] = [joint.damping for joint in description.joints]
    start = backend.clock.now_ns() + 5_000_000
    positions, imu = [], []
    for tick in range(ticks):
        backend.clock.sleep_until_ns(tick_time_ns(start, tick, RATE))
        frame = backend.read()
        positions.append(frame.joint_position.copy())
        imu.append(frame.imu_orientation.copy())
        command.position[:] = description.start_position + np.array(0.1 * np.sin(0.2 * tick))
        backend.write(command)
    return np.array(positions), np.array(imu)


@pytest.mark.parametrize("make", [direct, wired], ids=["mujoco", "bus"])
def test_a_seed_repeats_every_reading_and_another_does_not(minibiped, make):
    runs = [sway(minibiped, make(minibiped, seed)[0]) for seed in (1, 1, 2)]
    np.testing.assert_array_equal(runs[0][0], runs[1][0])
    np.testing.assert_array_equal(runs[0][1], runs[1][1])
    assert (runs[0][1] != runs[2][1]).any()


def test_both_rungs_move_alike(minibiped):
    """The same commands through bytes and without them: joints within a few encoder counts."""
    a, _ = sway(minibiped, direct(minibiped)[0])
    b, _ = sway(minibiped, wired(minibiped)[0])
    assert np.abs(a - b).max() < 0.01


def test_modelled_delays_are_those_of_the_bus(minibiped):
    """When the answers are in, and when the goals act, tick by tick, against the formulas."""
    backend, plant = wired(minibiped)
    backend.open()
    backend.read()
    backend.arm()
    command = JointCommand.zeros(12)
    command.stiffness[:], command.damping[:] = 18.9, 0.851
    start = backend.clock.now_ns() + 5_000_000
    reads, acts = [], []
    for tick in range(60):
        tick_ns = tick_time_ns(start, tick, RATE)
        backend.clock.sleep_until_ns(tick_ns)
        backend.read()
        reads.append(backend.clock.now_ns() - tick_ns)
        command.position[:] = minibiped.start_position + np.array(0.1 * np.sin(0.5 * tick))
        before = plant.servos.goal.copy()
        backend.write(command)
        for _ in range(150):
            backend.clock.sleep_until_ns(backend.clock.now_ns() + 20_000)
            if (plant.servos.goal != before).all():
                acts.append(backend.clock.now_ns() - tick_ns)
                break
    assert np.median(reads) == pytest.approx(read_time_ns(minibiped), abs=60_000)
    assert np.median(acts) == pytest.approx(command_latency_ns(minibiped), abs=80_000)


def test_goals_act_after_the_latency_not_before(minibiped):
    backend, plant = direct(minibiped)
    backend.open()
    backend.read()
    backend.arm()
    start = backend.clock.now_ns()
    command = JointCommand.zeros(12)
    command.stiffness[:], command.damping[:] = 18.9, 0.851
    command.position[:] = np.array(minibiped.start_position) + 0.2
    before = plant.servos.goal.copy()
    backend.write(command)
    due = start + command_latency_ns(minibiped)
    last = max(i for i in range(20) if plant.grid_time_ns(i) < due)
    backend.clock.sleep_until_ns(plant.grid_time_ns(last))
    np.testing.assert_array_equal(plant.servos.goal, before)
    backend.clock.sleep_until_ns(plant.grid_time_ns(last + 1))
    assert (plant.servos.goal != before).all()


def test_a_latency_of_several_ticks_keeps_every_command(minibiped):
    timing = minibiped.timing.model_copy(update={"compute_us": 9000})
    slow = minibiped.model_copy(update={"timing": timing})
    swings = [
        np.ptp(sway(description, direct(description)[0])[0][-63:, 0])
        for description in (minibiped, slow)
    ]
    assert swings[1] == pytest.approx(swings[0], rel=0.1)


def test_joint_readings_have_the_grain_of_their_registers(minibiped):
    backend, _ = direct(minibiped)
    sway(minibiped, backend, 30)
    frame = backend.read()
    speed = frame.joint_velocity / (0.229 * 2 * np.pi / 60)
    np.testing.assert_allclose(speed, np.rint(speed), atol=1e-9)
    np.testing.assert_allclose(frame.joint_voltage * 10, np.rint(frame.joint_voltage * 10))


def test_parts_that_do_not_fit_are_refused(minibiped):
    mapping = GainMapping(minibiped, calibration(minibiped))
    plant = Plant(minibiped, RATE, 0, mapping.motor_parameters())
    with pytest.raises(InputError, match="takes a servo mapping"):
        MujocoBackend(minibiped, plant, None, RATE)
    with pytest.raises(InputError, match="plant made for 300 Hz, loop at 225 Hz"):
        MujocoBackend(minibiped, plant, mapping, 225)


def test_frames_show_what_a_servo_has_shut_down_for(minibiped):
    """The same latched error that the registers of the bus would show."""
    frames = []
    for make in (direct, wired):
        backend, plant = make(minibiped)
        backend.open()
        backend.read()
        backend.arm()
        plant.servos.heat.case[3] = 95.0
        for _ in range(40):
            backend.clock.sleep_until_ns(backend.clock.now_ns() + 5_000_000)
            frame = backend.read()
        frames.append((frame.joint_error[3] != 0, frame.joint_error[4], plant.servos.enabled[3]))
    assert frames == [(True, 0, False)] * 2
