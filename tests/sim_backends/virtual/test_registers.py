"""Registers where real servos bite: ids, protocol type, firmware, backup, resets, busy times."""

import itertools

import pytest

from drivers.dynamixel import protocol
from drivers.dynamixel.control_table import BAUD_CODES, WATCHDOG_TRIPPED, Register
from drivers.dynamixel.protocol import BROADCAST_ID, Instruction, StatusError
from sim_backends.virtual.servo import EEPROM_WRITE_NS
from tests.sim_backends.virtual.conftest import Bench
from tests.sim_backends.virtual.test_servo import answers, read, write
from tests.sim_backends.virtual.test_wire import QUIET, TURNAROUND_NS, Client, byte_ns

PING_ALL = protocol.encode_instruction(BROADCAST_ID, Instruction.PING)


def test_a_secondary_id_is_obeyed_and_not_answered(bench):
    for servo_id in (1, 2):
        write(bench, Register.SHADOW_ID, 50, servo_id)
    assert bench.ask(protocol.encode_write(50, Register.LED.address, b"\x01")) == b""
    assert [bench.servos[i].registers[Register.LED] for i in (1, 2, 3)] == [1, 1, 0]
    bench.ask(protocol.encode_sync_write(Register.LED.address, 1, [(50, b"\x00")]))
    assert [bench.servos[i].registers[Register.LED] for i in (1, 2)] == [0, 0]


def test_a_primary_id_goes_before_a_secondary_one(bench):
    write(bench, Register.SHADOW_ID, 3, servo_id=1)
    assert write(bench, Register.LED, 1, servo_id=3) == 0
    assert bench.servos[1].registers[Register.LED] == 0


def test_another_protocol_type_is_deaf_to_this_one(bench):
    assert write(bench, Register.PROTOCOL_TYPE, 3) == StatusError.DATA_RANGE
    assert write(bench, Register.PROTOCOL_TYPE, 1) == 0
    assert bench.ask(protocol.encode_instruction(1, Instruction.PING)) == b""


def test_a_tripped_watchdog_is_cleared_by_zero_and_nothing_else(bench):
    write(bench, Register.PROFILE_VELOCITY, 40)
    write(bench, Register.TORQUE_ENABLE, 1)
    bench.servos[1].trip()
    assert read(bench, Register.BUS_WATCHDOG)[0] == WATCHDOG_TRIPPED
    assert bench.motors[1].told["profile"][:2] == (0, 0)
    for goal in (Register.GOAL_PWM, Register.GOAL_CURRENT, Register.GOAL_VELOCITY):
        assert write(bench, goal, 1) == StatusError.DATA_RANGE
    assert write(bench, Register.GOAL_POSITION, 2048) == StatusError.DATA_RANGE
    assert write(bench, Register.BUS_WATCHDOG, 5) == StatusError.DATA_RANGE
    assert write(bench, Register.BUS_WATCHDOG, 0) == 0
    assert bench.motors[1].told["profile"][:2] == (40, 0)
    assert write(bench, Register.GOAL_POSITION, 2048) == 0
    assert write(bench, Register.BUS_WATCHDOG, 5) == 0


def test_everybody_is_not_reset_to_the_same_id():
    reset_all = protocol.encode_instruction(BROADCAST_ID, Instruction.FACTORY_RESET, b"\xff")
    new, old = Bench([2, 3]), Bench([2, 3], firmware=41)
    for bench in (new, old):
        assert bench.ask(reset_all) == b""
        bench.now_ns += 1_000_000_000
    assert [servo.id for servo in new.servos.values()] == [2, 3]
    assert [servo.id for servo in old.servos.values()] == [1, 1]


def test_clear_wants_a_joint_at_rest_and_a_firmware_that_knows_it():
    clear = protocol.encode_instruction(1, Instruction.CLEAR, b"\x01\x44\x58\x4c\x22")
    bench = Bench([1])
    assert answers(bench.ask(clear)) == [(1, 0, b"")]
    bench.motors[1].measure(velocity=30)
    assert answers(bench.ask(clear)) == [(1, StatusError.RESULT_FAIL, b"")]
    assert answers(Bench([1], firmware=41).ask(clear)) == [(1, StatusError.INSTRUCTION, b"")]


def test_backup_needs_torque_off_and_something_to_restore(bench):
    store, restore = (
        protocol.encode_instruction(1, Instruction.BACKUP, bytes((n,)) + b"CTRL") for n in (1, 2)
    )
    assert answers(bench.ask(restore)) == [(1, StatusError.RESULT_FAIL, b"")]
    write(bench, Register.TORQUE_ENABLE, 1)
    assert answers(bench.ask(store)) == [(1, StatusError.RESULT_FAIL, b"")]


def test_startup_configuration_brings_gains_and_indirect_addresses_back(bench):
    write(bench, Register.STARTUP_CONFIGURATION, 2)
    write(bench, Register.POSITION_P_GAIN, 444)
    bench.ask(protocol.encode_write(1, 168, (132).to_bytes(2, "little")))
    bench.ask(protocol.encode_instruction(1, Instruction.BACKUP, b"\x01CTRL"))
    write(bench, Register.POSITION_P_GAIN, 555)
    bench.ask(protocol.encode_instruction(1, Instruction.REBOOT))
    bench.now_ns += 1_000_000_000
    assert read(bench, Register.POSITION_P_GAIN)[0] == 444
    assert bench.motors[1].told["gains"][0] == 444
    assert read(bench, Register.BACKUP_READY)[0] == 1
    assert bench.servos[1].registers.memory[168] == 132


def test_old_firmware_lacks_watchdog_fast_reads_backup_and_drive_modes():
    bench = Bench([1, 2], firmware=37)
    assert write(bench, Register.BUS_WATCHDOG, 1) == StatusError.ACCESS
    assert write(bench, Register.DRIVE_MODE, 4) == StatusError.DATA_RANGE
    assert bench.ask(protocol.encode_sync_read([1, 2], 132, 4, fast=True)) == b""
    backup = protocol.encode_instruction(1, Instruction.BACKUP, b"\x01CTRL")
    assert answers(bench.ask(backup)) == [(1, StatusError.INSTRUCTION, b"")]
    assert len(answers(bench.ask(protocol.encode_sync_read([1, 2], 132, 4)))) == 2


def test_one_old_servo_ends_a_fast_read_of_the_others(robot):
    made = robot(*QUIET)
    made.inject("servo:left_knee:old_firmware=44")
    client = Client(made)
    packet = protocol.encode_sync_read(range(1, 7), 132, 4, fast=True)
    data, _ = client.ask(packet, 56, 10_000_000)
    blocks = protocol.decode_fast_status(data, [4] * 6)
    assert [block.id for block in blocks] == [1, 2, 3]
    assert client.ask(protocol.encode_instruction(4, Instruction.PING), 14)[0][11] == 44


def test_a_hardware_error_of_the_motor_is_latched_by_the_registers(bench):
    write(bench, Register.TORQUE_ENABLE, 1)
    bench.motors[1].errors = 32
    assert read(bench, Register.PRESENT_POSITION)[1] == protocol.ALERT
    assert read(bench, Register.HARDWARE_ERROR_STATUS)[0] == 32
    assert not bench.motors[1].on


def test_broadcast_ping_is_answered_in_slots_of_three_milliseconds(robot):
    made = robot(*QUIET)
    client = Client(made)
    data, times = client.ask(PING_ALL, 6 * 14)
    assert len(data) == 6 * 14
    gaps = [b[0] - a[0] for a, b in itertools.pairwise(times)]
    assert gaps == [3_000_000] * 5


def test_an_eeprom_write_is_answered_when_it_is_done(robot):
    made = robot(*QUIET, "timing.usb_transfer_us=1")
    client = Client(made)

    def answer_time(register):
        made.clock.sleep_until_ns(-(-made.clock.now_ns() // 10_000_000) * 10_000_000)
        packet = protocol.encode_write(1, register.address, register.spec.encode(0))
        return client.ask(packet, 11)[1][0][0]

    # Quantised by the adapter's latency timer of 1 ms.
    late = answer_time(Register.SHADOW_ID) - answer_time(Register.LED)
    assert late == pytest.approx(EEPROM_WRITE_NS, abs=1_000)
    assert byte_ns(11) + TURNAROUND_NS < EEPROM_WRITE_NS


def test_a_broadcast_eeprom_write_leaves_servos_deaf_for_a_moment(bench):
    bench.ask(protocol.encode_sync_write(Register.RETURN_DELAY_TIME.address, 1, [(1, b"\x05")]))
    ping = protocol.encode_instruction(1, Instruction.PING)
    assert bench.ask(ping) == b""
    bench.now_ns += EEPROM_WRITE_NS
    assert bench.ask(ping)


@pytest.mark.parametrize("baud", BAUD_CODES)
def test_every_speed_of_the_model_takes_effect_at_once_up_to_four_and_a_half_megabit(bench, baud):
    assert write(bench, Register.BAUD_RATE, BAUD_CODES[baud]) == 0
    assert bench.ask(protocol.encode_instruction(1, Instruction.PING), BAUD_CODES[baud])


def test_trajectory_registers_follow_the_profile(bench):
    bench.motors[1].measure(position=1500)
    assert read(bench, Register.POSITION_TRAJECTORY)[0] == 1500
