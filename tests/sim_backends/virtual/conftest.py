"""Emulated servos on a motor that a test holds in its hand, and a client that asks a bus."""

import pytest

from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import PacketReader
from drivers.dynamixel.servo_models import find_servo_model
from sim_backends.virtual.dispatch import Dispatcher
from sim_backends.virtual.motors import Reading
from sim_backends.virtual.register_file import RegisterFile
from sim_backends.virtual.robot import VirtualRobot
from sim_backends.virtual.servo import EmulatedServo

BAUD = 4_000_000


class HandMotor:
    """Measures what the test says, and remembers what it was told."""

    def __init__(self):
        self.measured = Reading(0, 0, 0, 2048, 120, 30)
        self.on = False
        self.goal = self.gains = None

    def measure(self, **values):
        self.measured = self.measured._replace(**values)

    def reading(self):
        return self.measured

    def enable(self, on):
        self.on = on

    def set_goal(self, counts):
        self.goal = counts

    def set_gains(self, *gains):
        self.gains = gains


class Bench:
    """Servos on a wire without time: packets in, answers out."""

    def __init__(self, ids, model="XM430-W350"):
        self.now_ns = 0
        self.motors = {servo_id: HandMotor() for servo_id in ids}
        self.servos = {
            servo_id: EmulatedServo(
                RegisterFile(find_servo_model(model), servo_id, BAUD), motor, lambda: self.now_ns
            )
            for servo_id, motor in self.motors.items()
        }
        self._dispatcher = Dispatcher(list(self.servos.values()))

    def ask(self, packet, baud_code=6):
        """Everything that the servos answer to packets at 4 Mbit/s, in one string."""
        replies = []
        for request in PacketReader().feed(packet):
            replies += self._dispatcher.handle(request, baud_code, self.now_ns)
        return b"".join(reply.data for reply in replies)

    def set(self, servo_id, **registers):
        for name, value in registers.items():
            self.servos[servo_id].registers[Register[name]] = value


@pytest.fixture
def bench():
    return Bench([1, 2, 3])


@pytest.fixture
def robot(make_plant):
    """A virtual robot on the lockstep clock, its lines registered with pyserial."""
    robots = []

    def make(*overrides, seed=0, rate=300):
        plant = make_plant(*overrides, seed=seed, rate=rate)
        made = VirtualRobot(plant.description, plant, seed, rate)
        made.start()
        robots.append(made)
        return made

    yield make
    for made in robots:
        made.close()
