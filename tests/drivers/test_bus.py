"""The hot path: whole and broken answers, silent servos, alerts, writes."""

import numpy as np
import pytest

from drivers.dynamixel.blocks import IN_TURN, WHOLE
from drivers.dynamixel.bus import POLL_EVERY, ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.chain import DROP_AFTER, Chain
from drivers.dynamixel.control_table import WATCHDOG_TRIPPED, HardwareError, Register
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.protocol import Instruction, PacketReader
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.states import ServoStates
from hil.interface import JointError
from hil.servo import ServoGoals
from tests.drivers.conftest import FakeBusPort, FakeServo

IDS = range(1, 7)
PERIOD_NS = 3_333_333


class Rig:
    """Six servos whose joints come in reverse order of their ids."""

    def __init__(self, port, timing, clock, fast, blocks=(WHOLE,)):
        self.port = port
        self.clock = clock
        self.states = ServoStates.empty(6)
        servos = [BusServo(servo_id, 6 - servo_id) for servo_id in IDS]
        idle = IdleReader(list(IDS), blocks, timing.baud)
        self.bus = ServoBus("left_leg", port, timing, servos, self.states, fast, idle)
        self.group = BusGroup([self.bus], clock)
        self.due_ns = 0
        for servo_id in IDS:
            self.move(servo_id, 2000 + servo_id)

    def move(self, servo_id, position):
        servo = self.port.servos[servo_id]
        servo[Register.PRESENT_POSITION] = position
        servo[Register.PRESENT_VELOCITY] = -servo_id
        servo[Register.PRESENT_CURRENT] = -1

    def error(self, servo_id):
        return int(self.states.error[6 - servo_id])

    def tick(self, goals=None, spare_ns=1_000_000):
        self.due_ns += PERIOD_NS
        self.clock.sleep_until_ns(self.due_ns)
        self.states.valid[:] = False
        self.group.send_reads()
        self.group.receive()
        self.group.write(goals, spare_ns)
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


@pytest.mark.parametrize("blocks", [(WHOLE,), IN_TURN], ids=["whole", "in turn"])
def test_slow_registers_of_every_servo_come_in_turn(fake_port, timing, clock, blocks):
    rig = Rig(fake_port, timing, clock, True, blocks)
    for servo_id in IDS:
        rig.port.servos[servo_id][Register.PRESENT_INPUT_VOLTAGE] = 110 + servo_id
        rig.port.servos[servo_id][Register.PRESENT_TEMPERATURE] = 40 + servo_id
    for _ in range(6 * POLL_EVERY * len(blocks) + 1):
        assert rig.tick() == list(IDS)
    np.testing.assert_allclose(rig.states.voltage, [11.6, 11.5, 11.4, 11.3, 11.2, 11.1])
    np.testing.assert_allclose(rig.states.temperature, [46, 45, 44, 43, 42, 41])


def test_nothing_is_read_in_idle_time_that_is_not_there(rig):
    for _ in range(6 * POLL_EVERY + 1):
        rig.tick(spare_ns=100_000)
    assert np.isnan(rig.states.voltage).all()
    assert {packet.instruction for packet in rig.sent_instructions()} <= {0x82, 0x8A}


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
    rig.tick()
    assert rig.tick() == list(IDS)
    assert rig.position(3) == 2103


def test_a_lost_servo_is_looked_for_in_idle_time_and_taken_back(rig):
    rig.port.servos[1].silent = True
    for _ in range(DROP_AFTER):
        rig.tick()
    assert rig.bus.counters.timeouts == DROP_AFTER
    for _ in range(20):
        before_ns = rig.due_ns + PERIOD_NS
        assert rig.tick() == [2, 3, 4, 5, 6]
        assert rig.clock.now_ns() == before_ns  # nobody waited for it
    assert rig.bus.counters.timeouts == DROP_AFTER
    rig.port.servos[1].silent = False
    rig.tick()
    assert rig.tick() == list(IDS)


def test_a_dead_bus_ends_at_its_deadline_and_changes_nothing(rig):
    rig.tick()
    for servo in rig.port.servos.values():
        servo.silent = True
    before = rig.due_ns + PERIOD_NS
    assert rig.tick() == []
    assert 0 < rig.clock.now_ns() - before < 2_500_000
    assert rig.position(4) == 2004
    assert rig.bus.counters.timeouts == 1
    assert rig.bus.counters.stale == 6


def test_a_bus_that_was_dead_for_a_while_is_back_at_once(rig):
    rig.tick()
    for servo in rig.port.servos.values():
        servo.silent = True
    for _ in range(30):
        assert rig.tick() == []
    for servo in rig.port.servos.values():
        servo.silent = False
    assert rig.tick() == list(IDS)


def test_a_damaged_answer_is_dropped_and_counted(fast_rig):
    rig = fast_rig
    rig.tick()
    # One flipped bit in the block of the fourth servo, which begins at byte 8 + 3·20.
    rig.port.damage = lambda data: data[:71] + bytes((data[71] ^ 4,)) + data[72:]
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
    fake_port.damage = lambda data: data[:40] + bytes((data[40] ^ 4,)) + data[41:]
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
    assert rig.error(2) == JointError.UNEXPLAINED
    assert rig.tick() == list(IDS)
    assert rig.error(2) == HardwareError.OVERLOAD
    for _ in range(20):
        assert rig.tick() == list(IDS)
    rig.port.servos[2][Register.HARDWARE_ERROR_STATUS] = 0
    rig.tick()
    assert rig.error(2) == 0


def armed(rig):
    for servo_id in IDS:
        rig.port.servos[servo_id][Register.TORQUE_ENABLE] = 1
        rig.port.servos[servo_id][Register.BUS_WATCHDOG] = 2
    rig.tick()
    rig.group.arm(True)
    rig.tick()
    return rig


def test_a_servo_that_rebooted_is_found_by_its_clock_and_stays_reported(rig):
    armed(rig)
    servo = rig.port.servos[3]
    servo.booted_ns = rig.clock.now_ns()
    servo[Register.TORQUE_ENABLE] = 0
    assert rig.tick() == list(IDS)
    assert rig.error(3) == JointError.REBOOTED
    for _ in range(2 * POLL_EVERY):
        assert rig.tick() == list(IDS)
    assert rig.error(3) == JointError.REBOOTED | JointError.TORQUE_LOST
    servo[Register.TORQUE_ENABLE] = 1
    for _ in range(20):
        rig.tick()
    assert rig.error(3)
    assert rig.error(4) == 0
    rig.group.arm(True)
    rig.tick()
    assert rig.error(3) == 0


def test_a_servo_that_comes_back_is_looked_at_before_it_is_believed(rig):
    armed(rig)
    servo = rig.port.servos[5]
    servo.silent = True
    for _ in range(4):
        rig.tick()
    servo.silent = False
    servo[Register.BUS_WATCHDOG] = -1 & WATCHDOG_TRIPPED
    rig.tick()
    assert rig.tick() == list(IDS)
    assert rig.error(5) == JointError.STOPPED


def test_lost_torque_is_found_in_turn(rig):
    armed(rig)
    rig.port.servos[6][Register.TORQUE_ENABLE] = 0
    for _ in range(6 * POLL_EVERY + 1):
        assert rig.tick() == list(IDS)
    assert rig.error(6) == JointError.TORQUE_LOST


def test_torque_that_is_off_before_arming_is_no_error(rig):
    for _ in range(6 * POLL_EVERY + 1):
        rig.tick()
    assert not rig.states.error.any()


def test_a_servo_whose_clock_stands_still_is_not_heard(rig):
    rig.tick()
    frozen = rig.port.servos[4]
    frozen.measure = lambda _: None
    valid = [rig.tick() for _ in range(20)]
    assert valid[3:] == [[1, 2, 3, 5, 6]] * 17
    assert rig.bus.counters.timeouts == 0


def test_an_answer_of_one_servo_that_comes_a_tick_late_is_not_taken_for_fresh(timing, clock):
    # One servo: the order of the answers cannot tell, its clock does.
    port = FakeBusPort({1: FakeServo()}, clock)
    states = ServoStates.empty(1)
    idle = IdleReader([1], (WHOLE,), timing.baud)
    bus = ServoBus("left_leg", port, timing, [BusServo(1, 0)], states, False, idle)
    group = BusGroup([bus], clock)
    answers = []
    times = []
    for tick in range(12):
        clock.sleep_until_ns(tick * PERIOD_NS)
        states.valid[:] = False
        if tick == 6:
            port.damage = lambda data: answers.append(data) or b""
        elif tick > 6:  # From now on every answer is that to the request before.
            port.damage = lambda data: answers.append(data) or answers[-2]
        group.send_reads()
        group.receive()
        times.append((tick * PERIOD_NS - int(states.time_ns[0]), bool(states.valid[0])))
    assert all(valid and age_ns <= 0 for age_ns, valid in times[:6])
    assert times[6][1] is False
    assert times[7][1]
    assert times[7][0] == pytest.approx(PERIOD_NS, abs=1_500_000)


def test_a_servo_that_answers_now_and_then_does_not_cost_its_neighbours(rig):
    rig.tick()
    lost = 0
    for tick in range(100):
        rig.port.servos[1].silent = tick % 3 == 0
        lost += 5 - len(set(rig.tick()) - {1})
    assert lost <= 5


def test_a_plain_answer_that_is_lost_on_the_way_does_not_hide_those_behind(
    fake_port, timing, clock
):
    rig = Rig(fake_port, timing, clock, fast=False)
    rig.tick()
    size = 11 + 16
    fake_port.damage = lambda data: data[: 2 * size] + data[3 * size :]
    assert rig.tick() in ([1, 2, 4, 5, 6], [1, 2, 3, 5, 6])


def make_goals(**changes):
    values = {"position": 2048, "p_gain": 800, "d_gain": 0, "pwm_limit": 885, **changes}
    return ServoGoals(**{name: np.full(6, value) for name, value in values.items()})


def test_only_positions_are_written_once_gains_are_known(rig):
    rig.bus.write(make_goals(), 0)
    first = rig.sent_instructions()
    assert [int.from_bytes(packet.params[:2], "little") for packet in first] == [84, 80, 100, 116]
    rig.bus.write(make_goals(position=2049), 0)
    (packet,) = rig.sent_instructions()
    assert packet.instruction == Instruction.SYNC_WRITE
    assert rig.port.servos[4][Register.GOAL_POSITION] == 2049
    assert rig.port.servos[4][Register.POSITION_P_GAIN] == 800


def test_a_changed_gain_is_written_to_that_servo_alone(rig):
    rig.bus.write(make_goals(), 0)
    rig.sent_instructions()
    goals = make_goals()
    goals.p_gain[0] = 850
    rig.bus.write(goals, 0)
    gain, _ = rig.sent_instructions()
    assert gain.params == bytes([84, 0, 2, 0, 6]) + (850).to_bytes(2, "little")
    assert rig.port.servos[6][Register.POSITION_P_GAIN] == 850


def test_a_lost_gain_write_is_mended_in_time(rig):
    rig.bus.write(make_goals(), 0)
    rig.port.servos[2][Register.POSITION_P_GAIN] = 0
    for _ in range(6 * POLL_EVERY + 1):
        rig.tick(make_goals())
    assert rig.port.servos[2][Register.POSITION_P_GAIN] == 800


def test_negative_goals_are_stuffed(rig):
    rig.bus.write(make_goals(position=-131073), 0)  # FF FF FD FF
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
                chain.missed(place, bool(heard))
                break
            chain.heard(place)
            heard.add(place)
    assert heard == {1, 3}
    assert set(chain.silent) == silent
