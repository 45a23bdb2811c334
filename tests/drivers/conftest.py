"""An in-memory servo bus for driver tests: tables behind a port that answers at once."""

import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.control_table import REALTIME_TICK_MODULUS, Register
from drivers.dynamixel.protocol import (
    ALERT,
    Instruction,
    PacketReader,
    crc16,
    encode_status,
    fast_status_block,
    fast_status_start,
)
from hil.clock import ManualClock


class FakeServo:
    """A register file without rules; `refuses` lists registers whose writes are ignored."""

    def __init__(self, number=1020, firmware=45):
        self.table = bytearray(256)
        self.refuses = set()
        self.silent = False
        self.booted_ns = -1_000_000_000
        self[Register.MODEL_NUMBER] = number
        self[Register.FIRMWARE_VERSION] = firmware
        self[Register.RETURN_DELAY_TIME] = 250
        self[Register.OPERATING_MODE] = 3
        self[Register.MAX_POSITION_LIMIT] = 4095
        self[Register.PRESENT_POSITION] = 2048
        self[Register.PRESENT_INPUT_VOLTAGE] = 120
        self[Register.PRESENT_TEMPERATURE] = 30

    def __setitem__(self, register, value):
        self.table[register.address : register.end] = register.spec.encode(value)

    def __getitem__(self, register):
        return register.spec.decode(bytes(self.table[register.address : register.end]))

    def write(self, address, data):
        if not any(register.address == address for register in self.refuses):
            self.table[address : address + len(data)] = data

    def measure(self, now_ns):
        tick = (now_ns - self.booted_ns) // 1_000_000 % REALTIME_TICK_MODULUS
        self[Register.REALTIME_TICK] = tick

    @property
    def error(self):
        return ALERT if self[Register.HARDWARE_ERROR_STATUS] else 0


class FakeBusPort:
    """Servos by id, behind what `ServoBus`, `GroupAccess` and `SdkPort` use of a Port."""

    def __init__(self, servos, clock):
        self.clock = clock
        self.name = "left_leg"
        self.url = "fake"
        self.baud = 4_000_000
        self.stream = self
        self.servos = servos
        self.received = b""
        self.sent = []
        self.damage = lambda answer: answer
        self.knows_fast = True
        self.sent_bytes = self.received_bytes = 0

    @property
    def in_waiting(self):
        return len(self.received)

    def write(self, data):
        self.sent.append(data)
        for packet in PacketReader().feed(data):
            self.received += self.damage(self.answer(packet))

    def read_available(self):
        data, self.received = self.received, b""
        return data

    def discard_input(self):
        return len(self.read_available())

    def answer(self, packet):
        params = packet.params
        match packet.instruction:
            case Instruction.SYNC_WRITE:
                size = int.from_bytes(params[2:4], "little") + 1
                for start in range(4, len(params), size):
                    servo = self.servos.get(params[start])
                    if servo:
                        address = int.from_bytes(params[:2], "little")
                        servo.write(address, params[start + 1 : start + size])
                return b""
            case Instruction.SYNC_READ | Instruction.FAST_SYNC_READ:
                address, length = (int.from_bytes(params[i : i + 2], "little") for i in (0, 2))
                items = [(servo_id, address, length) for servo_id in params[4:]]
            case Instruction.BULK_READ | Instruction.FAST_BULK_READ:
                parts = [params[i : i + 5] for i in range(0, len(params), 5)]
                items = [(p[0], p[1] | p[2] << 8, p[3] | p[4] << 8) for p in parts]
            case _:
                return self.answer_one(packet)
        fast = packet.instruction in (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)
        return self.answer_chain(items, fast)

    def answer_chain(self, items, fast):
        if fast and not self.knows_fast:
            return b""
        out = fast_status_start([length for _, _, length in items]) if fast else b""
        crc = crc16(out)
        for position, (servo_id, address, length) in enumerate(items):
            servo = self.servos.get(servo_id)
            if servo is None or servo.silent:
                return out if position else b""
            servo.measure(self.clock.now_ns())
            data = bytes(servo.table[address : address + length])
            if fast:
                block, crc = fast_status_block(crc, servo.error, servo_id, data)
                out += block
            else:
                out += encode_status(servo_id, servo.error, data)
        return out

    def answer_one(self, packet):
        servo = self.servos.get(packet.id)
        if servo is None or servo.silent:
            return b""
        address = int.from_bytes(packet.params[:2], "little")
        match packet.instruction:
            case Instruction.PING:
                data = bytes(servo.table[0:2] + servo.table[6:7])
            case Instruction.READ:
                length = int.from_bytes(packet.params[2:4], "little")
                data = bytes(servo.table[address : address + length])
            case Instruction.WRITE:
                servo.write(address, packet.params[2:])
                data = b""
            case _:
                data = b""
        return encode_status(packet.id, servo.error, data)


TIMING = BusTiming(baud=4_000_000, latency_timer_ns=1_000_000, usb_transfer_ns=125_000)


@pytest.fixture
def timing():
    return TIMING


@pytest.fixture
def clock():
    return ManualClock()


@pytest.fixture
def fake_port(clock):
    """A bus of six XM430-W350 with ids 1 to 6."""
    return FakeBusPort({servo_id: FakeServo() for servo_id in range(1, 7)}, clock)


@pytest.fixture
def calibration():
    """Ideal load cells of 0.0005 N/count around 100000 counts."""
    foot = {"zero": [1e5] * 4, "scale": [5e-4] * 4}
    data = {
        "robot": "minibiped",
        "provenance": {"date": "2026-01-01", "method": "ideal"},
        "feet": {"left": foot, "right": foot},
    }
    return RobotCalibration.model_validate(data)
