"""Emulated servos against the examples of the e-manual (DYNAMIXEL Protocol 2.0), byte for byte."""

import pytest

from drivers.dynamixel import protocol
from drivers.dynamixel.control_table import Register
from tests.sim_backends.virtual.conftest import Bench


def raw(text):
    return bytes.fromhex(text)


PING_1 = raw("FFFFFD00 01 0300 01 194E")
PING_ALL = raw("FFFFFD00 FE 0300 01 3142")
STATUS_PING_1 = raw("FFFFFD00 01 0700 55 00 060426 655D")
STATUS_PING_2 = raw("FFFFFD00 02 0700 55 00 060426 6F6D")
READ_POSITION = raw("FFFFFD00 01 0700 02 84000400 1D15")
STATUS_166 = raw("FFFFFD00 01 0800 55 00 A6000000 8CC0")
WRITE_GOAL_512 = raw("FFFFFD00 01 0900 03 740000020000 CA89")
STATUS_OK = raw("FFFFFD00 01 0400 55 00 A10C")
REG_WRITE_VELOCITY = raw("FFFFFD00 01 0900 04 6800C8000000 AE8E")
ACTION = raw("FFFFFD00 01 0300 05 02CE")
FACTORY_RESET_KEEP_ID = raw("FFFFFD00 01 0400 06 01 A1E6")
REBOOT = raw("FFFFFD00 01 0300 08 2F4E")
CLEAR = raw("FFFFFD00 01 0800 10 0144584C22 B1DC")
SYNC_READ = raw("FFFFFD00 FE 0900 82 840004000102 CEFA")
STATUS_2079 = raw("FFFFFD00 02 0800 55 00 1F080000 BABE")
SYNC_WRITE = raw("FFFFFD00 FE 1100 83 74000400 0196000000 02AA000000 8287")
BULK_READ = raw("FFFFFD00 FE 0D00 92 0190000200 0292000100 1A05")
STATUS_VOLTAGE = raw("FFFFFD00 01 0600 55 00 7700 C369")
STATUS_TEMPERATURE = raw("FFFFFD00 02 0500 55 00 24 8BA9")
BULK_WRITE = raw("FFFFFD00 FE 1000 93 0120000200A000 021F00010050 B768")
FAST_SYNC_READ = raw("FFFFFD00 FE 0A00 8A 84000400030704 20F2")
FAST_SYNC_ANSWER = raw(
    "FFFFFD00 FE 1900 55 00 03 A6000000 8408 00 07 1F080000 16CA 00 04 FF030000 D19E"
)
FAST_BULK_ANSWER = raw("FFFFFD00 FE 1400 55 00 03 A6000000 67A4 00 07 A501 2474 00 04 1F D9C1")
BACKUP = raw("FFFFFD00 01 0800 20 01 4354524C 16F5")
RESTORE = raw("FFFFFD00 01 0800 20 02 4354524C 9EF5")  # The manual misprints the CRC: 92F5.


@pytest.fixture
def examples():
    """The servos of the examples: XM430-W210 that answer to a ping with firmware 38."""
    bench = Bench([1, 2], "XM430-W210")
    for servo_id in (1, 2):
        bench.set(servo_id, FIRMWARE_VERSION=38)
    bench.motors[1].measure(position=166, voltage=119)
    bench.motors[2].measure(position=2079, temperature=36)
    return bench


@pytest.mark.parametrize(
    ("request_packet", "answer"),
    [
        (PING_1, STATUS_PING_1),
        (PING_ALL, STATUS_PING_1 + STATUS_PING_2),
        (READ_POSITION, STATUS_166),
        (WRITE_GOAL_512, STATUS_OK),
        (REG_WRITE_VELOCITY, STATUS_OK),
        (FACTORY_RESET_KEEP_ID, STATUS_OK),
        (REBOOT, STATUS_OK),
        (CLEAR, STATUS_OK),
        (SYNC_READ, STATUS_166 + STATUS_2079),
        (SYNC_WRITE, b""),
        (BULK_READ, STATUS_VOLTAGE + STATUS_TEMPERATURE),
        (BULK_WRITE, b""),
    ],
    ids=[
        *("ping", "ping all", "read", "write", "reg write", "factory reset", "reboot", "clear"),
        *("sync read", "sync write", "bulk read", "bulk write"),
    ],
)
def test_published_requests_get_the_published_answers(examples, request_packet, answer):
    assert examples.ask(request_packet).hex(" ") == answer.hex(" ")


def test_published_fast_sync_read_gets_the_published_answer():
    bench = Bench([3, 4, 7], "XM430-W210")
    for servo_id, position in ((3, 166), (7, 2079), (4, 1023)):
        bench.motors[servo_id].measure(position=position)
    assert bench.ask(FAST_SYNC_READ).hex(" ") == FAST_SYNC_ANSWER.hex(" ")


def test_the_published_answer_to_a_fast_bulk_read():
    """The request's own CRC is misprinted there: it is that of the fast sync read."""
    bench = Bench([3, 4, 7], "XC330-T288")
    bench.motors[3].measure(position=166)
    bench.motors[7].measure(pwm=421)
    bench.motors[4].measure(temperature=31)
    items = [(3, 132, 4), (7, 124, 2), (4, 146, 1)]
    request_packet = protocol.encode_bulk_read(items, fast=True)
    assert request_packet[:-2] == raw("FFFFFD00 FE 1200 9A 0384000400 077C000200 0492000100")
    assert bench.ask(request_packet).hex(" ") == FAST_BULK_ANSWER.hex(" ")


def test_published_backup_and_restore():
    bench = Bench([1], "XC330-T288")
    registers = bench.servos[1].registers
    assert bench.ask(BACKUP) == STATUS_OK
    assert registers[Register.BACKUP_READY] == 1
    bench.set(1, RETURN_DELAY_TIME=99)
    assert bench.ask(RESTORE) == STATUS_OK
    assert registers[Register.RETURN_DELAY_TIME] == 0
    assert bench.ask(PING_1) == b""
    bench.now_ns += 1_000_000_000
    assert bench.ask(PING_1)


def test_published_writes_have_their_effect(examples):
    examples.ask(WRITE_GOAL_512)
    assert examples.motors[1].goal == 512
    examples.ask(SYNC_WRITE)
    assert [examples.motors[i].goal for i in (1, 2)] == [150, 170]
    examples.ask(BULK_WRITE)
    assert examples.servos[1].registers[Register.MAX_VOLTAGE_LIMIT] == 160
    assert examples.servos[2].registers[Register.TEMPERATURE_LIMIT] == 80


def test_registered_write_waits_for_action(examples):
    registers = examples.servos[1].registers
    examples.ask(REG_WRITE_VELOCITY)
    assert registers[Register.GOAL_VELOCITY] == 0
    assert registers[Register.REGISTERED_INSTRUCTION] == 1
    assert examples.ask(ACTION) == STATUS_OK
    assert registers[Register.GOAL_VELOCITY] == 200
    assert registers[Register.REGISTERED_INSTRUCTION] == 0
