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
        self.told = {}
        self.errors = 0

    def measure(self, **values):
        self.measured = self.measured._replace(**values)

    def reading(self):
        return self.measured

    def trajectory(self):
        return 0, self.measured.position

    def enable(self, on):
        self.on = on

    def hardware_error(self):
        return self.errors

    def reboot(self):
        self.errors = 0

    def __getattr__(self, name):
        """`set_x` remembers what it was told under x."""
        if not name.startswith("set_"):
            raise AttributeError(name)
        return lambda *values: self.told.update({name[4:]: values})

    @property
    def goal(self):
        return self.told["goal"][0]


class Bench:
    """Servos on a wire without time: packets in, answers out."""

    def __init__(self, ids, model="XM430-W350", firmware=48):
        self.now_ns = 0
        self.motors = {servo_id: HandMotor() for servo_id in ids}
        self.servos = {
            servo_id: EmulatedServo(
                RegisterFile(find_servo_model(model), servo_id, BAUD, firmware),
                motor,
                lambda: self.now_ns,
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
def patient_sdk(monkeypatch):
    """The SDK waits 2·16 + 2 ms for an answer, which a busy machine may miss: here ten times that.

    Only its constant for the adapter's latency timer is raised, as users of slow adapters do.
    """
    monkeypatch.setattr("dynamixel_sdk.port_handler.LATENCY_TIMER", 160)


@pytest.fixture
def bench():
    return Bench([1, 2, 3])


@pytest.fixture
def robot(make_plant):
    """A virtual robot on the lockstep clock, its lines registered with pyserial."""
    robots = []

    def make(*overrides, seed=0, rate=300, delay_us=0):
        """`delay_us`: of the foot boards."""
        plant = make_plant(*overrides, seed=seed, rate=rate)
        boards = {
            name: board.model_copy(update={"delay_us": delay_us}) if board.kind == "foot" else board
            for name, board in plant.description.boards.items()
        }
        description = plant.description.model_copy(update={"boards": boards})
        made = VirtualRobot(description, plant, seed, rate)
        made.start()
        robots.append(made)
        return made

    yield make
    for made in robots:
        made.close()
