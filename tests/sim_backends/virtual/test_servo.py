"""The firmware's rules: what is refused, what is reset, what latches, who stays silent."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.dynamixel import protocol
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import ALERT, Instruction, PacketReader, StatusError
from drivers.dynamixel.servo_models import SERVO_MODELS
from tests.sim_backends.virtual.conftest import Bench


def answers(data):
    return [(p.id, p.error, p.data) for p in PacketReader().feed(data)]


def write(bench, register, value, servo_id=1):
    """Error byte of the answer, None when there is no answer."""
    packet = protocol.encode_write(servo_id, register.address, register.spec.encode(value))
    replies = answers(bench.ask(packet))
    return replies[0][1] if replies else None


def read(bench, register, servo_id=1):
    ((_, error, data),) = answers(
        bench.ask(protocol.encode_read(servo_id, register.address, register.size))
    )
    return register.spec.decode(data), error


@pytest.mark.parametrize(
    ("register", "value", "error"),
    [
        (Register.PRESENT_POSITION, 5, StatusError.ACCESS),
        (Register.MODEL_NUMBER, 5, StatusError.ACCESS),
        (Register.STATUS_RETURN_LEVEL, 3, StatusError.DATA_RANGE),
        (Register.BAUD_RATE, 8, StatusError.DATA_RANGE),
        (Register.OPERATING_MODE, 2, StatusError.DATA_RANGE),
        (Register.POSITION_P_GAIN, 16384, StatusError.DATA_RANGE),
        (Register.BUS_WATCHDOG, 128, StatusError.DATA_RANGE),
        (Register.GOAL_PWM, 886, StatusError.DATA_LIMIT),
        (Register.GOAL_PWM, -886, StatusError.DATA_LIMIT),
        (Register.GOAL_POSITION, 4096, StatusError.DATA_LIMIT),
        (Register.GOAL_POSITION, -1, StatusError.DATA_LIMIT),
        (Register.GOAL_VELOCITY, 201, StatusError.DATA_LIMIT),
        (Register.CURRENT_LIMIT, 1194, StatusError.DATA_RANGE),
    ],
    ids=lambda value: getattr(value, "name", value),
)
def test_bad_writes_are_refused_and_leave_the_register(bench, register, value, error):
    before = bench.servos[1].registers[register]
    assert write(bench, register, value) == error
    assert bench.servos[1].registers[register] == before


def test_a_write_to_part_of_a_register_has_the_wrong_length(bench):
    packet = protocol.encode_write(1, Register.GOAL_POSITION.address, b"\x00\x04")
    assert answers(bench.ask(packet)) == [(1, StatusError.DATA_LENGTH, b"")]


def test_one_bad_register_keeps_the_whole_write_out(bench):
    data = (900).to_bytes(2, "little") + (5).to_bytes(2, "little") + (20000).to_bytes(2, "little")
    packet = protocol.encode_write(1, Register.POSITION_D_GAIN.address, data)
    assert answers(bench.ask(packet))[0][1] == StatusError.DATA_RANGE
    assert bench.servos[1].registers[Register.POSITION_D_GAIN] == 0


def test_eeprom_is_locked_while_torque_is_on(bench):
    assert write(bench, Register.TORQUE_ENABLE, 1) == 0
    assert write(bench, Register.RETURN_DELAY_TIME, 10) == StatusError.ACCESS
    assert write(bench, Register.POSITION_P_GAIN, 500) == 0
    assert write(bench, Register.TORQUE_ENABLE, 0) == 0
    assert write(bench, Register.RETURN_DELAY_TIME, 10) == 0


def test_unknown_instructions_are_refused(bench):
    assert answers(bench.ask(protocol.encode_instruction(1, 0x77))) == [
        (1, StatusError.INSTRUCTION, b"")
    ]


def test_reads_outside_the_table_are_refused(bench):
    assert answers(bench.ask(protocol.encode_read(1, 660, 10)))[0][1] == StatusError.ACCESS


def test_a_new_operating_mode_resets_gains_profile_and_goals(bench):
    for register, value in (
        (Register.POSITION_P_GAIN, 500), (Register.PROFILE_VELOCITY, 33), (Register.GOAL_PWM, 100),
    ):  # fmt: skip
        write(bench, register, value)
    assert write(bench, Register.OPERATING_MODE, 4) == 0
    registers = bench.servos[1].registers
    assert registers[Register.POSITION_P_GAIN] == 800
    assert registers[Register.PROFILE_VELOCITY] == 0
    assert registers[Register.GOAL_PWM] == 885
    assert write(bench, Register.GOAL_POSITION, 100_000) == 0


def test_an_operating_mode_that_stays_resets_nothing(bench):
    write(bench, Register.POSITION_P_GAIN, 500)
    assert write(bench, Register.OPERATING_MODE, 3) == 0
    assert bench.servos[1].registers[Register.POSITION_P_GAIN] == 500


def test_mode_limits_and_goals_of_every_loop_reach_the_motor(bench):
    write(bench, Register.OPERATING_MODE, 5)
    write(bench, Register.CURRENT_LIMIT, 900)
    write(bench, Register.PWM_LIMIT, 700)
    write(bench, Register.GOAL_CURRENT, -300)
    write(bench, Register.GOAL_VELOCITY, 55)
    write(bench, Register.POSITION_I_GAIN, 7)
    write(bench, Register.FEEDFORWARD_1ST_GAIN, 8)
    write(bench, Register.VELOCITY_P_GAIN, 90)
    write(bench, Register.PROFILE_VELOCITY, 40)
    told = bench.motors[1].told
    assert (told["mode"], told["limits"]) == ((5,), (700, 900))
    assert (told["goal_current"], told["goal_velocity"]) == ((-300,), (55,))
    assert (told["gains"], told["velocity_gains"]) == ((800, 7, 0, 8, 0), (90, 1920))
    assert told["profile"] == (40, 0, False)


def test_reverse_mode_turns_every_goal(bench):
    write(bench, Register.DRIVE_MODE, 1)
    write(bench, Register.OPERATING_MODE, 0)
    write(bench, Register.GOAL_CURRENT, 300)
    write(bench, Register.GOAL_PWM, 200)
    told = bench.motors[1].told
    assert (told["goal_current"], told["goal_pwm"]) == ((-300,), (-200,))


def test_torque_and_goals_reach_the_motor(bench):
    write(bench, Register.POSITION_P_GAIN, 640)
    write(bench, Register.GOAL_PWM, 500)
    write(bench, Register.GOAL_POSITION, 1000)
    write(bench, Register.TORQUE_ENABLE, 1)
    motor = bench.motors[1]
    assert (motor.on, motor.goal) == (True, 1000)
    assert (motor.told["gains"], motor.told["goal_pwm"]) == ((640, 0, 0, 0, 0), (500,))


def test_torque_on_by_goal_update_is_as_treacherous_as_the_real_one(bench):
    write(bench, Register.DRIVE_MODE, 8)
    write(bench, Register.GOAL_POSITION, 1000)
    assert bench.motors[1].on


def test_homing_offset_and_reverse_mode_shift_and_turn_the_position(bench):
    bench.motors[1].measure(position=2148, velocity=7)
    write(bench, Register.HOMING_OFFSET, 50)
    assert read(bench, Register.PRESENT_POSITION)[0] == 2198
    write(bench, Register.DRIVE_MODE, 1)
    assert read(bench, Register.PRESENT_POSITION)[0] == 1998
    assert read(bench, Register.PRESENT_VELOCITY)[0] == -7
    write(bench, Register.GOAL_POSITION, 1998)
    assert bench.motors[1].goal == 2148
    write(bench, Register.HOMING_OFFSET, 1025)
    assert read(bench, Register.PRESENT_POSITION)[0] == 1948


@pytest.mark.parametrize(("level", "answered"), [(0, (1, 0, 0)), (1, (1, 1, 0)), (2, (1, 1, 1))])
def test_status_return_level(bench, level, answered):
    write(bench, Register.STATUS_RETURN_LEVEL, level)
    packets = (
        protocol.encode_instruction(1, Instruction.PING),
        protocol.encode_read(1, 132, 4),
        protocol.encode_write(1, Register.LED.address, b"\x01"),
    )
    assert tuple(len(answers(bench.ask(packet))) for packet in packets) == answered


def test_another_speed_is_not_heard(bench):
    ping = protocol.encode_instruction(1, Instruction.PING)
    assert bench.ask(ping, baud_code=3) == b""
    assert write(bench, Register.BAUD_RATE, 3) == 0
    assert bench.ask(ping, baud_code=6) == b""
    assert bench.ask(ping, baud_code=3)


def test_a_new_id_is_taken_at_once(bench):
    assert write(bench, Register.ID, 9) == 0
    assert write(bench, Register.LED, 1, servo_id=1) is None
    assert write(bench, Register.LED, 1, servo_id=9) == 0


@pytest.mark.parametrize("fast", [False, True])
def test_a_missing_servo_silences_those_behind_it(bench, fast):
    packet = protocol.encode_sync_read([1, 99, 3], 132, 4, fast=fast)
    reply = bench.ask(packet)
    if fast:
        blocks = protocol.decode_fast_status(reply, [4, 4, 4])
        assert [block.id for block in blocks] == [1]
        assert reply[5:7] == bytes((1 + 3 * 8, 0))
    else:
        assert [servo_id for servo_id, *_ in answers(reply)] == [1]


def test_a_missing_servo_at_the_head_silences_all(bench):
    assert bench.ask(protocol.encode_sync_read([99, 1, 2], 132, 4)) == b""


def test_overheating_alerts_cuts_torque_and_latches_until_reboot(bench):
    write(bench, Register.TORQUE_ENABLE, 1)
    bench.motors[1].measure(temperature=81)
    assert read(bench, Register.PRESENT_TEMPERATURE) == (81, ALERT)
    assert not bench.motors[1].on
    assert read(bench, Register.HARDWARE_ERROR_STATUS) == (4, ALERT)
    bench.motors[1].measure(temperature=40)
    assert write(bench, Register.TORQUE_ENABLE, 1) == ALERT
    assert read(bench, Register.TORQUE_ENABLE) == (0, ALERT)
    bench.ask(protocol.encode_instruction(1, Instruction.REBOOT))
    bench.now_ns += 1_000_000_000
    assert write(bench, Register.TORQUE_ENABLE, 1) == 0
    assert read(bench, Register.TORQUE_ENABLE) == (1, 0)


def test_low_voltage_alerts_but_keeps_the_torque_that_the_mask_allows(bench):
    write(bench, Register.TORQUE_ENABLE, 1)
    bench.motors[1].measure(voltage=90)
    read(bench, Register.PRESENT_INPUT_VOLTAGE)
    assert read(bench, Register.HARDWARE_ERROR_STATUS) == (1, ALERT)
    assert bench.motors[1].on


def test_reboot_keeps_eeprom_resets_ram_and_takes_a_while(bench):
    write(bench, Register.RETURN_DELAY_TIME, 20)
    write(bench, Register.POSITION_P_GAIN, 500)
    write(bench, Register.TORQUE_ENABLE, 1)
    bench.motors[1].measure(position=1500)
    ping = protocol.encode_instruction(1, Instruction.PING)
    assert bench.ask(protocol.encode_instruction(1, Instruction.REBOOT))
    assert bench.ask(ping) == b""
    bench.now_ns += 1_000_000_000
    assert bench.ask(ping)
    assert read(bench, Register.RETURN_DELAY_TIME)[0] == 20
    assert read(bench, Register.POSITION_P_GAIN)[0] == 800
    assert read(bench, Register.TORQUE_ENABLE)[0] == 0
    assert read(bench, Register.GOAL_POSITION)[0] == 1500
    assert not bench.motors[1].on


@pytest.mark.parametrize(
    ("parameter", "servo_id", "baud_code"), [(0x02, 2, 6), (0x01, 2, 1), (0xFF, 1, 1)]
)
def test_factory_reset_keeps_what_it_is_told_to(parameter, servo_id, baud_code):
    bench = Bench([2])
    packet = protocol.encode_instruction(2, Instruction.FACTORY_RESET, bytes((parameter,)))
    assert answers(bench.ask(packet)) == [(2, 0, b"")]
    bench.now_ns += 1_000_000_000
    ping = protocol.encode_instruction(servo_id, Instruction.PING)
    assert bench.ask(ping, baud_code)
    assert bench.servos[2].registers[Register.RETURN_DELAY_TIME] == 250


def test_realtime_tick_counts_milliseconds_and_wraps(bench):
    bench.now_ns = 32_767_999_999
    assert read(bench, Register.REALTIME_TICK)[0] == 32767
    bench.now_ns = 32_768_000_000
    assert read(bench, Register.REALTIME_TICK)[0] == 0


def test_indirect_data_follows_its_addresses_both_ways(bench):
    places = Register.PRESENT_POSITION.address, Register.PRESENT_TEMPERATURE.address
    cells = [*range(places[0], places[0] + 4), places[1]]
    table = b"".join(cell.to_bytes(2, "little") for cell in cells)
    assert answers(bench.ask(protocol.encode_write(1, 168, table)))[0][1] == 0
    bench.motors[1].measure(position=1234, temperature=41)
    ((_, _, data),) = answers(bench.ask(protocol.encode_read(1, 224, 5)))
    assert (int.from_bytes(data[:4], "little"), data[4]) == (1234, 41)
    gain = Register.POSITION_P_GAIN.address
    table = gain.to_bytes(2, "little") + (gain + 1).to_bytes(2, "little")
    bench.ask(protocol.encode_write(1, 168, table))
    assert answers(bench.ask(protocol.encode_write(1, 224, b"\xf4\x01")))[0][1] == 0
    assert bench.motors[1].told["gains"][0] == 500


@pytest.mark.parametrize("model", SERVO_MODELS)
def test_every_model_starts_with_its_factory_values(model):
    bench = Bench([1], model)
    registers = bench.servos[1].registers
    assert registers[Register.MODEL_NUMBER] == SERVO_MODELS[model].number
    assert registers[Register.POSITION_P_GAIN] == SERVO_MODELS[model].position_gains[0]
    assert registers[Register.SHUTDOWN] == int(SERVO_MODELS[model].shutdown)
    if SERVO_MODELS[model].current_limit is None:
        assert write(bench, Register.GOAL_CURRENT, 1) == StatusError.ACCESS


@given(
    instruction=st.integers(0, 255),
    servo_id=st.sampled_from([1, 2, 99, 0xFE]),
    params=st.binary(max_size=40),
)
def test_no_packet_upsets_a_servo(instruction, servo_id, params):
    bench = Bench([1, 2])
    bench.ask(protocol.encode_instruction(servo_id, instruction, params))
    bench.now_ns += 1_000_000_000
    assert len(bench.servos) == 2
