"""The hot path: whole and broken answers, silent servos, alerts, writes."""

import numpy as np
import pytest

from drivers.dynamixel.bus import FAST_TRIALS, POLL_EVERY, ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.chain import GIVE_UP_AFTER, PROBE_EVERY, Chain
from drivers.dynamixel.control_table import HardwareError, Register
from drivers.dynamixel.protocol import Instruction, PacketReader
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.states import ALERT_UNKNOWN, ServoStates
from hil.servo import ServoGoals

IDS = range(1, 7)


class Rig:
    """Six servos whose joints come in reverse order of their ids."""

    def __init__(self, port, timing, clock, fast):
        self.port = port
        self.clock = clock
        self.states = ServoStates.empty(6)
        servos = [BusServo(servo_id, 6 - servo_id) for servo_id in IDS]
        self.bus = ServoBus("left_leg", port, timing, servos, self.states, fast)
        self.group = BusGroup([self.bus], clock)
        for servo_id in IDS:
            self.move(servo_id, 2000 + servo_id)

    def move(self, servo_id, position):
        servo = self.port.servos[servo_id]
        servo[Register.PRESENT_POSITION] = position
        servo[Register.PRESENT_VELOCITY] = -servo_id
        servo[Register.PRESENT_CURRENT] = -1

    def tick(self):
        self.states.valid[:] = False
        self.group.send_reads()
        self.group.receive()
        return [servo_id for servo_id in IDS if self.states.valid[6 - servo_id]]

    def position(self, servo_id):
        return int(self.states.position[6 - servo_id])

    def sent_instructions(self):
        packets = [packet for data in self.port.sent for packet in PacketReader().feed(data)]
        self.port.sent.clear()
        return packets


@pytest.fixture(params=[True, False], ids=["fast", "plain"])
def rig(request, fake_port, timing, clock):
    return Rig(fake_port, timing, clock, request.param)


@pytest.fixture
def fast_rig(fake_port, timing, clock):
    return Rig(fake_port, timing, clock, True)


def test_a_tick_reads_every_servo(rig):
    assert rig.tick() == list(IDS)
    assert [rig.position(servo_id) for servo_id in IDS] == [2001, 2002, 2003, 2004, 2005, 2006]
    assert rig.states.velocity.tolist() == [-6, -5, -4, -3, -2, -1]
    assert rig.states.current.tolist() == [-1] * 6
    assert (rig.states.time_ns > 0).all()
    assert rig.bus.counters.stale == 0


def test_values_that_look_like_headers_are_read_right(rig):
    # Present Current -1 (FF FF) followed by a velocity byte FD: stuffed in a plain answer.
    for servo_id in IDS:
        rig.port.servos[servo_id][Register.PRESENT_VELOCITY] = 0xFD
    assert rig.tick() == list(IDS)
    assert rig.states.velocity.tolist() == [0xFD] * 6


def test_slow_registers_of_every_servo_come_in_turn(rig):
    for servo_id in IDS:
        rig.port.servos[servo_id][Register.PRESENT_INPUT_VOLTAGE] = 110 + servo_id
        rig.port.servos[servo_id][Register.PRESENT_TEMPERATURE] = 40 + servo_id
    for _ in range(6 * POLL_EVERY):
        assert rig.tick() == list(IDS)
    np.testing.assert_allclose(rig.states.voltage, [11.6, 11.5, 11.4, 11.3, 11.2, 11.1])
    np.testing.assert_allclose(rig.states.temperature, [46, 45, 44, 43, 42, 41])


def test_a_silent_servo_keeps_its_old_values_and_costs_the_others_one_tick(rig):
    rig.tick()
    rig.port.servos[3].silent = True
    for servo_id in IDS:
        rig.move(servo_id, 2100 + servo_id)
    # The order turns round every tick: 6, 5, 4, 3 or 1, 2, 3 …
    first = rig.tick()
    assert first in ([4, 5, 6], [1, 2])
    unheard = [servo_id for servo_id in IDS if servo_id not in first]
    assert all(rig.position(servo_id) == 2000 + servo_id for servo_id in unheard)
    assert all(rig.position(servo_id) == 2100 + servo_id for servo_id in first)
    assert rig.tick() == [1, 2, 4, 5, 6]
    assert rig.position(3) == 2003
    assert rig.position(6) == 2106
    assert rig.states.time_ns[3] < rig.states.time_ns[0]
    rig.port.servos[3].silent = False
    assert rig.tick() == list(IDS)
    assert rig.position(3) == 2103


def test_a_lost_servo_is_only_probed_and_taken_back(rig):
    rig.port.servos[1].silent = True
    for _ in range(GIVE_UP_AFTER):
        rig.tick()
    timeouts = rig.bus.counters.timeouts
    for _ in range(2 * PROBE_EVERY):
        assert rig.tick() == [2, 3, 4, 5, 6]
    assert rig.bus.counters.timeouts - timeouts <= 2
    rig.port.servos[1].silent = False
    assert any(rig.tick() == list(IDS) for _ in range(PROBE_EVERY))
    assert rig.tick() == list(IDS)


def test_a_dead_bus_ends_at_its_deadline_and_changes_nothing(rig):
    rig.tick()
    for servo in rig.port.servos.values():
        servo.silent = True
    before = rig.clock.now_ns()
    assert rig.tick() == []
    assert 0 < rig.clock.now_ns() - before < 2_500_000
    assert rig.position(4) == 2004
    assert rig.bus.counters.timeouts == 1
    assert rig.bus.counters.stale == 6


def test_a_damaged_answer_is_dropped_and_counted(fast_rig):
    rig = fast_rig
    rig.tick()
    # One flipped bit in the block of the fourth servo, which begins at byte 8 + 3·14.
    rig.port.damage = lambda data: data[:53] + bytes((data[53] ^ 4,)) + data[54:]
    for servo_id in IDS:
        rig.move(servo_id, 3000)
    heard = rig.tick()
    assert heard in ([1, 2, 3], [4, 5, 6])
    assert [rig.position(servo_id) == 3000 for servo_id in IDS].count(True) == 3
    assert (rig.bus.counters.crc_errors, rig.bus.counters.timeouts) == (1, 0)
    rig.port.damage = lambda data: data
    assert rig.tick() == list(IDS)


def test_a_damaged_plain_answer_costs_one_servo(fake_port, timing, clock):
    rig = Rig(fake_port, timing, clock, fast=False)
    fake_port.damage = lambda data: data[:30] + bytes((data[30] ^ 4,)) + data[31:]
    assert rig.tick() in ([1, 3, 4, 5, 6], [1, 2, 3, 4, 6])
    assert rig.bus.counters.crc_errors == 1


def test_stale_bytes_of_an_earlier_tick_are_not_taken_for_an_answer(fast_rig):
    fast_rig.tick()
    fast_rig.port.received = b"\xff\xff\xfd\x00\xfe" * 9
    assert fast_rig.tick() == list(IDS)


def test_an_answer_that_comes_a_tick_late_is_not_taken_for_the_next(rig):
    rig.tick()
    late = []
    rig.port.damage = lambda data: late.append(data) or b""
    assert rig.tick() == []
    rig.port.damage = lambda data: late[0] + data
    for servo_id in IDS:
        rig.move(servo_id, 3000 + servo_id)
    rig.tick()
    assert [rig.position(servo_id) for servo_id in IDS] == [3000 + i for i in IDS]
    assert rig.bus.counters.late


def test_an_answer_that_comes_a_tick_late_is_better_than_none(fast_rig):
    late = []
    fast_rig.port.damage = lambda data: late.append(data) or b""
    assert fast_rig.tick() == []
    sampled_ns = fast_rig.clock.now_ns()
    fast_rig.port.damage = lambda data: late.append(data) or late[0]
    for servo_id in IDS:
        fast_rig.move(servo_id, 3000 + servo_id)
    assert fast_rig.tick() == list(IDS)
    assert [fast_rig.position(servo_id) for servo_id in IDS] == [2000 + i for i in IDS]
    assert (fast_rig.states.time_ns < sampled_ns).all()
    fast_rig.port.damage = lambda data: late[1] + data
    assert fast_rig.tick() == list(IDS)
    assert [fast_rig.position(servo_id) for servo_id in IDS] == [3000 + i for i in IDS]
    assert fast_rig.bus.counters.late == 2


def test_noise_before_the_answer_does_not_hide_it(fast_rig):
    fast_rig.port.damage = lambda data: b"\x00\xff\xff" + data
    assert fast_rig.tick() == list(IDS)


def test_an_alert_is_seen_at_once_and_its_cause_is_read_next(rig):
    rig.tick()
    rig.port.servos[2][Register.HARDWARE_ERROR_STATUS] = HardwareError.OVERLOAD
    assert rig.tick() == list(IDS)
    assert rig.states.error[4] == ALERT_UNKNOWN
    assert rig.tick() == list(IDS)
    assert rig.states.error[4] == HardwareError.OVERLOAD
    for _ in range(20):
        assert rig.tick() == list(IDS)
    rig.port.servos[2][Register.HARDWARE_ERROR_STATUS] = 0
    rig.tick()
    assert rig.states.error[4] == 0


def test_servos_without_fast_reads_are_read_plainly_in_the_end(fast_rig):
    fast_rig.port.knows_fast = False
    for _ in range(20 * FAST_TRIALS):
        fast_rig.tick()
    assert not fast_rig.bus.fast
    assert any(fast_rig.tick() == list(IDS) for _ in range(2 * PROBE_EVERY * 6))


def make_goals(**changes):
    values = {"position": 2048, "p_gain": 800, "d_gain": 0, "pwm_limit": 885, **changes}
    return ServoGoals(**{name: np.full(6, value) for name, value in values.items()})


def test_only_positions_are_written_once_gains_are_known(rig):
    rig.bus.write(make_goals())
    first = rig.sent_instructions()
    assert [int.from_bytes(packet.params[:2], "little") for packet in first] == [84, 80, 100, 116]
    rig.bus.write(make_goals(position=2049))
    (packet,) = rig.sent_instructions()
    assert packet.instruction == Instruction.SYNC_WRITE
    assert rig.port.servos[4][Register.GOAL_POSITION] == 2049
    assert rig.port.servos[4][Register.POSITION_P_GAIN] == 800


def test_a_changed_gain_is_written_to_that_servo_alone(rig):
    rig.bus.write(make_goals())
    rig.sent_instructions()
    goals = make_goals()
    goals.p_gain[0] = 850
    rig.bus.write(goals)
    gain, _ = rig.sent_instructions()
    assert gain.params == bytes([84, 0, 2, 0, 6]) + (850).to_bytes(2, "little")
    assert rig.port.servos[6][Register.POSITION_P_GAIN] == 850


def test_a_lost_gain_write_is_mended_in_time(rig):
    rig.bus.write(make_goals())
    rig.port.servos[2][Register.POSITION_P_GAIN] = 0
    for _ in range(6 * POLL_EVERY):
        rig.tick()
        rig.bus.write(make_goals())
    assert rig.port.servos[2][Register.POSITION_P_GAIN] == 800


def test_negative_goals_are_stuffed(rig):
    rig.bus.write(make_goals(position=-131073))  # FF FF FD FF
    assert rig.port.servos[1][Register.GOAL_POSITION] == -131073


def test_several_silent_servos_do_not_hide_the_others():
    chain = Chain(4)
    silent = {0, 2}
    heard = set()
    for _ in range(12):
        members = chain.members()
        heard = set()
        for place in members:
            if place in silent:
                chain.missed(place)
                break
            chain.heard(place)
            heard.add(place)
    assert heard == {1, 3}
    assert set(chain.silent) == silent
