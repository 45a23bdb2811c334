"""Faults of a virtual robot, seen from the host's end of its serial lines."""

import itertools

import pytest
import serial

from drivers.boards.frames import ALL_CELLS, FrameReader
from drivers.dynamixel import protocol
from drivers.dynamixel.control_table import WATCHDOG_TRIPPED, Register
from drivers.dynamixel.protocol import ALERT, Instruction, PacketReader
from hil.fault_spec import parse_fault
from tests.sim_backends.virtual.test_wire import QUIET, Client

KNEE, KNEE_ID = "left_knee", 4
PING = protocol.encode_instruction(KNEE_ID, Instruction.PING)
PONG = 14
ALL_SIX = range(1, 7)
MS = 1_000_000


def wait(robot, milliseconds):
    robot.clock.sleep_until_ns(robot.clock.now_ns() + int(milliseconds * MS))


def read(client, register, servo_id=KNEE_ID):
    """Value and error byte of a register; None when nothing came back."""
    packet = protocol.encode_read(servo_id, register.address, register.size)
    data, _ = client.ask(packet, 11 + register.size, 10 * MS)
    packets = [packet for packet in PacketReader().feed(data) if packet.is_status]
    return (register.spec.decode(packets[0].data), packets[0].error) if packets else None


def write(client, register, value, servo_id=KNEE_ID):
    data = register.spec.encode(value)
    return client.ask(protocol.encode_write(servo_id, register.address, data), 11, 10 * MS)[0]


@pytest.fixture
def made(robot):
    return robot(*QUIET)


@pytest.fixture
def client(made):
    return Client(made)


def pings(client, count):
    """Lengths of the answers to pings."""
    return [len(client.ask(PING, PONG, 5 * MS)[0]) for _ in range(count)]


# Wire faults ---------------------------------------------------------------------------------


def test_a_dropped_packet_is_lost_either_way(made, client):
    made.inject("bus:left_leg:drop=1,rx@0+0.02")
    assert pings(client, 1) == [0]
    wait(made, 20)
    assert pings(client, 1) == [PONG]
    made.inject("bus:left_leg:drop=1,tx")
    write(client, Register.LED, 1)
    assert made.servos[KNEE].registers[Register.LED] == 0


def test_a_share_of_packets_is_lost_the_same_ones_for_a_seed(robot):
    def lost(seed):
        made = robot(*QUIET, seed=seed)
        made.inject("bus:left_leg:drop=0.3,rx")
        return [size == 0 for size in pings(Client(made), 200)]

    first = lost(0)
    assert 40 <= sum(first) <= 80
    assert lost(0) == first
    assert lost(1) != first


def test_a_flipped_bit_is_one_bit(made, client):
    clean, _ = client.ask(PING, PONG)
    made.inject("bus:left_leg:flip=1,rx")
    dirty, _ = client.ask(PING, PONG)
    assert sum((a ^ b).bit_count() for a, b in zip(clean, dirty, strict=True)) == 1


def test_truncated_packets_lose_their_end(made, client):
    clean, _ = client.ask(PING, PONG)
    made.inject("bus:left_leg:truncate=1,rx")
    short, _ = client.ask(PING, PONG, 5 * MS)
    assert len(short) < len(clean)
    assert clean.startswith(short)


def test_duplicates_come_twice_and_garbage_comes_before(made, client):
    clean, _ = client.ask(PING, PONG)
    made.inject("bus:left_leg:duplicate=1,rx@0+0.01")
    assert client.ask(PING, 2 * PONG, 5 * MS)[0] == clean + clean
    wait(made, 10)
    made.inject("bus:left_leg:garbage=1,rx")
    noisy, _ = client.ask(PING, PONG + 20, 5 * MS)
    assert noisy.endswith(clean)
    assert 1 <= len(noisy) - len(clean) <= 16


def test_a_delayed_answer_comes_late_and_whole(made, client):
    clean, ((prompt, _),) = client.ask(PING, PONG)
    made.inject("bus:left_leg:delay=1,20,rx")
    late_data, ((late, _),) = client.ask(PING, PONG)
    assert late_data == clean
    assert 19 * MS <= late - prompt <= 21 * MS


def test_an_echo_gives_the_host_its_own_packets(made, client):
    made.inject("bus:left_leg:echo")
    data, _ = client.ask(PING, len(PING) + PONG)
    assert data.startswith(PING)
    assert PacketReader().feed(data)[1].is_status


def test_colliding_senders_pull_bits_low(made, client):
    clean, _ = client.ask(PING, PONG)
    made.inject("bus:left_leg:collide=1,rx")
    garbled, _ = client.ask(PING, PONG)
    assert garbled != clean
    assert all(a & b == b for a, b in zip(clean, garbled, strict=True))


def test_an_adapter_that_is_pulled_out_fails_until_it_is_opened_again(made, client):
    made.inject("bus:left_leg:disconnect@0+0.05")
    with pytest.raises(serial.SerialException, match="disconnected"):
        client.port.write(PING)
    with pytest.raises(serial.SerialException, match="disconnected"):
        _ = client.port.in_waiting
    with pytest.raises(serial.SerialException, match="no such device"):
        Client(made)
    made.clock.wait_readable([client.port], made.clock.now_ns() + MS)
    wait(made, 50)
    with pytest.raises(serial.SerialException, match="disconnected"):
        client.port.write(PING)
    again = Client(made)
    client.port.close()
    assert pings(again, 1) == [PONG]


# Servo faults --------------------------------------------------------------------------------


def test_a_silent_servo_silences_those_behind_it_and_comes_back(made, client):
    packet = protocol.encode_sync_read(ALL_SIX, 132, 4)
    made.inject(f"servo:{KNEE}:silent@0+0.05")
    found = PacketReader().feed(client.ask(packet, 90, 10 * MS)[0])
    assert [status.id for status in found] == [1, 2, 3]
    wait(made, 50)
    assert len(client.ask(packet, 90, 10 * MS)[0]) == 90


def test_a_silent_servo_hears_nothing_so_its_watchdog_trips_on_a_busy_bus(made, client):
    write(client, Register.BUS_WATCHDOG, 1)
    write(client, Register.TORQUE_ENABLE, 1)
    made.inject(f"servo:{KNEE}:silent@0+0.1")
    for _ in range(12):
        client.ask(protocol.encode_instruction(1, 1), PONG, 5 * MS)
        wait(made, 5)
    wait(made, 50)
    assert made.servos[KNEE].registers.memory[Register.BUS_WATCHDOG.address] == WATCHDOG_TRIPPED


def test_a_servo_that_is_silent_now_and_then(made, client):
    made.inject(f"servo:{KNEE}:silent=0.5")
    answered = pings(client, 40)
    assert 8 <= answered.count(PONG) <= 32
    assert set(answered) == {0, PONG}


def test_a_frozen_servo_answers_yesterday_s_news(made, client):
    made.inject(f"servo:{KNEE}:frozen")
    before = read(client, Register.REALTIME_TICK), read(client, Register.PRESENT_POSITION)
    wait(made, 30)
    assert (read(client, Register.REALTIME_TICK), read(client, Register.PRESENT_POSITION)) == before


def test_a_reboot_leaves_torque_off_and_ram_reset(made, client):
    write(client, Register.TORQUE_ENABLE, 1)
    write(client, Register.POSITION_P_GAIN, 500)
    made.inject(f"servo:{KNEE}:reboot")
    assert read(client, Register.POSITION_P_GAIN) is None
    wait(made, 1000)
    assert read(client, Register.TORQUE_ENABLE) == (0, 0)
    assert read(client, Register.POSITION_P_GAIN) == (800, 0)


def test_an_alert_is_latched_and_shown_in_every_answer(made, client):
    write(client, Register.TORQUE_ENABLE, 1)
    made.inject(f"servo:{KNEE}:alert=input_voltage")
    assert read(client, Register.HARDWARE_ERROR_STATUS) == (1, ALERT)
    assert read(client, Register.TORQUE_ENABLE) == (1, ALERT)
    made.inject(f"servo:{KNEE}:alert=overload")
    assert read(client, Register.TORQUE_ENABLE) == (0, ALERT)


def test_overheating_rises_and_ends_in_the_firmware_s_own_shutdown(made, client):
    write(client, Register.TORQUE_ENABLE, 1)
    cold, _ = read(client, Register.PRESENT_TEMPERATURE)
    made.inject(f"servo:{KNEE}:overheat=90,0.2")
    wait(made, 100)
    middle, error = read(client, Register.PRESENT_TEMPERATURE)
    assert cold < middle < 80
    assert error == 0
    wait(made, 100)
    assert read(client, Register.PRESENT_TEMPERATURE) == (90, ALERT)
    assert read(client, Register.TORQUE_ENABLE) == (0, ALERT)


def test_a_low_supply_alerts(made, client):
    made.inject(f"servo:{KNEE}:undervoltage=8@0+0.1")
    assert read(client, Register.PRESENT_INPUT_VOLTAGE) == (80, ALERT)
    wait(made, 100)
    assert read(client, Register.PRESENT_INPUT_VOLTAGE)[0] == 120


def test_another_model_in_its_place(made, client):
    made.inject(f"servo:{KNEE}:wrong_model=1200")
    data, _ = client.ask(PING, PONG)
    (answer,) = PacketReader().feed(data)
    assert int.from_bytes(answer.data[:2], "little") == 1200


def test_two_servos_of_one_id_collide_and_both_obey(made, client):
    made.inject(f"servo:{KNEE}:wrong_id=3@0+0.1")
    assert pings(client, 1) == [0]
    write(client, Register.LED, 1, servo_id=3)
    lit = [made.servos[joint].registers[Register.LED] for joint in ("left_hip_pitch", KNEE)]
    assert lit == [1, 1]
    packet = protocol.encode_read(3, Register.PRESENT_POSITION.address, 4)
    garbled, _ = client.ask(packet, 15, 10 * MS)
    assert len(garbled) == 15
    assert PacketReader().feed(garbled) == []
    wait(made, 100)
    assert pings(client, 1) == [PONG]


def test_torque_that_is_lost_without_a_word(made, client):
    write(client, Register.TORQUE_ENABLE, 1)
    made.inject(f"servo:{KNEE}:lost_torque")
    assert read(client, Register.TORQUE_ENABLE) == (0, 0)


def test_a_tripped_watchdog_locks_the_goals(made, client):
    write(client, Register.TORQUE_ENABLE, 1)
    made.inject(f"servo:{KNEE}:watchdog_trip")
    assert write(client, Register.GOAL_POSITION, 2000)[8] == 4
    assert read(client, Register.BUS_WATCHDOG) == (WATCHDOG_TRIPPED, 0)


def test_a_drifting_encoder_takes_the_joint_with_it(made, client):
    knee = made.description.joint_names.index(KNEE)
    made.world.set_support(True)
    goal, _ = read(client, Register.PRESENT_POSITION)
    write(client, Register.GOAL_POSITION, goal)
    write(client, Register.TORQUE_ENABLE, 1)
    wait(made, 200)
    before = made.world.truth().joint_position[knee]
    made.inject(f"servo:{KNEE}:drift=-20")  # Bends the knee: the floor does not hold it.
    for _ in range(50):
        wait(made, 10)
        write(client, Register.GOAL_POSITION, goal)
    assert read(client, Register.PRESENT_POSITION)[0] == pytest.approx(goal, abs=40)
    assert made.world.truth().joint_position[knee] - before == pytest.approx(0.17, abs=0.06)


# Board faults --------------------------------------------------------------------------------


class Feet:
    """The host's end of a board's line."""

    def __init__(self, robot, name="left_foot"):
        self.robot = robot
        self.port = serial.serial_for_url(robot.port_urls[name], baudrate=921600, timeout=0)
        self.reader = FrameReader()

    def frames(self, milliseconds=30):
        self.port.reset_input_buffer()
        wait(self.robot, milliseconds)
        return self.reader.feed(self.port.read(self.port.in_waiting))


@pytest.fixture
def foot(made):
    return Feet(made)


def test_a_stale_board_sends_nothing(made, foot):
    made.inject("board:left_foot:stale@0+0.02")
    wait(made, 5)
    assert foot.frames(14) == []
    assert foot.frames()


def test_a_stuck_board_sends_old_values_in_new_frames(made, foot):
    made.inject("board:left_foot:stuck")
    frames = foot.frames()
    assert len(frames) > 10
    assert len({frame.counts for frame in frames}) == 1
    assert len({frame.device_time_us for frame in frames}) == len(frames)


def test_swapped_cells_and_swapped_feet(made, foot):
    made.inject("board:left_foot:stuck")
    counts = foot.frames()[-1].counts
    made.inject("board:left_foot:swapped")
    a, b, c, d = foot.frames()[-1].counts
    assert (b, a, d, c) == counts


def test_feet_on_each_other_s_board(made, foot):
    zeros = [made.calibration_data["feet"][side]["zero"] for side in ("left", "right")]
    made.inject("board:left_foot:swapped=feet")
    foot.frames(5)
    assert foot.frames()[-1].counts[0] == pytest.approx(zeros[1][0], rel=0.3)
    assert abs(zeros[0][0] - zeros[1][0]) > 0.6 * abs(zeros[1][0])


def test_an_open_cell_is_at_the_rail_and_says_so_a_saturated_one_does_not(made, foot):
    made.inject("board:left_foot:open_cell=rear_left@0+0.05")
    frame = foot.frames()[-1]
    assert (frame.counts[2], frame.status) == (8388607, ALL_CELLS & ~4)
    wait(made, 30)
    made.inject("board:left_foot:saturated=front_right")
    frame = foot.frames()[-1]
    assert (frame.counts[1], frame.status) == (8388607, ALL_CELLS)


def test_a_clock_that_jumps(made, foot):
    before = foot.frames()[-1]
    made.inject("board:left_foot:clock_jump=2")
    after = foot.frames()[-1]
    assert after.device_time_us - before.device_time_us == pytest.approx(2_030_000, abs=5000)


def test_a_slow_board_samples_less_often_without_gaps(made, foot):
    fast = len(foot.frames(60))
    made.inject("board:left_foot:slow=3")
    foot.frames(5)
    frames = foot.frames(60)
    assert len(frames) == pytest.approx(fast / 3, abs=2)
    steps = {b.sequence - a.sequence for a, b in itertools.pairwise(frames)}
    assert steps == {1}


def test_wire_faults_hit_boards_too(made, foot):
    made.inject("board:left_foot:flip=1")
    foot.frames(5)
    errors = foot.reader.crc_errors + foot.reader.skipped_bytes
    assert foot.frames() == []
    assert foot.reader.crc_errors + foot.reader.skipped_bytes > errors


# Plans ---------------------------------------------------------------------------------------


def test_a_plan_waits_for_its_epoch_but_for_what_is_there_from_the_start(made, client):
    early = parse_fault(f"servo:{KNEE}:wrong_model=1200")
    late = parse_fault(f"servo:{KNEE}:silent@0.1+0.1")
    made.faults.plan([early, late])
    assert made.servos[KNEE].registers[Register.MODEL_NUMBER] == 1200
    wait(made, 300)
    assert pings(client, 1) == [PONG]
    epoch = made.clock.now_ns()
    made.faults.begin(epoch)
    made.clock.sleep_until_ns(epoch + 150 * MS)
    assert pings(client, 1) == [0]
    made.clock.sleep_until_ns(epoch + 250 * MS)
    assert pings(client, 1) == [PONG]
