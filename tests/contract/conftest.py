"""Every backend behind the same few handles: the contract suite runs on each of them."""

from dataclasses import dataclass
from typing import Any

import pytest

from drivers.calibration import Provenance, RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.clock import MonotonicClock, tick_time_ns
from hil.description import RobotDescription
from hil.interface import JointCommand
from hil.robot_files import load_robot
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant
from sim_backends.virtual.remote import RemoteWorld, ServerProcess
from sim_backends.virtual.robot import VirtualRobot

RATE = 200
REAL_RATE = 50
PATIENCE_MS = 8
"""Real time on a busy machine: slow ticks, and a driver told of a slower adapter than it has, so
that it does not give up on answers which a scheduler holds back."""


@dataclass
class Rig:
    """One backend, its world, and a loop around them."""

    description: RobotDescription
    backend: Any
    world: Any
    rate: int = RATE
    ticks: int = 0
    start_ns: int = 0

    @property
    def n(self):
        return len(self.description.joints)

    @property
    def is_servo(self):
        return self.description.actuation == "servo"

    def begin(self):
        """Put the first tick a little ahead of now."""
        self.start_ns, self.ticks = self.backend.clock.now_ns() + 5_000_000, 0

    def tick(self, command=None):
        """Wait for the next tick, read, and write if there is a command; the frame."""
        self.backend.clock.sleep_until_ns(tick_time_ns(self.start_ns, self.ticks, self.rate))
        self.ticks += 1
        frame = self.backend.read()
        if command is not None:
            self.applied = self.backend.write(command)
        return frame

    def run(self, seconds, command=None):
        for _ in range(max(1, round(seconds * self.rate))):
            frame = self.tick(command)
        return frame

    def hold(self, position=None):
        """A command that holds joint angles with the default gains, or asks for no torque."""
        command = JointCommand.zeros(self.n)
        if self.is_servo:
            start = self.description.start_position if position is None else position
            command.position[:] = start
            command.stiffness[:] = [joint.stiffness for joint in self.description.joints]
            command.damping[:] = [joint.damping for joint in self.description.joints]
        return command


def _calibration(description, data):
    provenance = Provenance(date="2026-01-01", method="ideal")
    return RobotCalibration(robot=description.name, provenance=provenance, **data)


def _mujoco(robot, closers):
    description = load_robot(robot)
    mapping = motors = None
    if description.actuation == "servo":
        mapping = GainMapping(description, _calibration(description, {}))
        motors = mapping.motor_parameters()
    plant = Plant(description, RATE, 0, motors)
    return Rig(description, MujocoBackend(description, plant, mapping, RATE, 0), plant)


def _bus(description, clock, rate, urls, data):
    calibration = _calibration(description, data)
    mapping = GainMapping(description, calibration)
    return BusBackend(description, clock, rate, urls, calibration, mapping)


def _lockstep(robot, closers):
    description = load_robot(robot)
    mapping = GainMapping(description, _calibration(description, {}))
    plant = Plant(description, RATE, 0, mapping.motor_parameters())
    virtual = VirtualRobot(description, plant, 0, RATE)
    virtual.start()
    closers.append(virtual.close)
    backend = _bus(description, virtual.clock, RATE, virtual.port_urls, virtual.calibration_data)
    return Rig(description, backend, plant)


def _terminals(robot, closers):
    description = load_robot(robot)
    buses = {
        name: bus.model_copy(update={"latency_timer_ms": PATIENCE_MS})
        for name, bus in description.buses.items()
    }
    description = description.model_copy(update={"buses": buses})
    server = ServerProcess(robot, REAL_RATE, 0)
    closers.append(server.close)
    world = RemoteWorld(server.control)
    closers.append(world.close)
    clock, data = MonotonicClock(), world.calibration_data
    backend = _bus(description, clock, REAL_RATE, server.port_urls, data)
    return Rig(description, backend, world, REAL_RATE)


RIGS = {
    "mujoco-minibiped": (_mujoco, "minibiped"),
    "mujoco-human": (_mujoco, "human"),
    "bus-lockstep": (_lockstep, "minibiped"),
    "bus-terminals": (_terminals, "minibiped"),
}
SERVO_RIGS = [name for name in RIGS if name != "mujoco-human"]


def _params(names):
    marks = {"bus-terminals": pytest.mark.pty}
    return [pytest.param(name, marks=marks.get(name, ())) for name in names]


def _make(name):
    closers = []
    make, robot = RIGS[name]
    rig = make(robot, closers)
    yield rig
    rig.backend.close()
    for close in reversed(closers):
        close()


@pytest.fixture(params=_params(RIGS))
def rig(request):
    """Any backend, not open yet."""
    yield from _make(request.param)


@pytest.fixture(params=_params(SERVO_RIGS))
def servo_rig(request):
    """Any backend of a servo robot, not open yet."""
    yield from _make(request.param)


@pytest.fixture(params=["mujoco-human"])
def torque_rig(request):
    """Any backend of a torque robot, not open yet."""
    yield from _make(request.param)


@pytest.fixture
def opened(rig):
    """Open, and heard of every sensor."""
    rig.backend.open()
    rig.begin()
    rig.run(0.1)
    return rig


@pytest.fixture
def armed(servo_rig):
    """Torque on, body held, at the start pose."""
    servo_rig.backend.open()
    servo_rig.begin()
    servo_rig.run(0.1)
    servo_rig.backend.arm()
    servo_rig.begin()
    return servo_rig
