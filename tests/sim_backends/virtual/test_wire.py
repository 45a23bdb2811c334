"""Times on the wire: baud, turnaround, return delay, adapter, collisions, watchdog, compute."""

import numpy as np
import pytest
import serial

from drivers.dynamixel import protocol
from drivers.dynamixel.control_table import Register

QUIET = ("usb_jitter_us=0", "board_jitter_us=0")
USB_NS = 125_000
TURNAROUND_NS = 20_000
LATENCY_NS = 1_000_000
IDS = [1, 2, 3, 4, 5, 6]


class Client:
    """A host on one bus of a virtual robot."""

    def __init__(self, robot, name="left_leg", baud=4_000_000):
        self.clock = robot.clock
        self.port = serial.serial_for_url(robot.port_urls[name], baudrate=baud, timeout=0)

    def ask(self, packet, size, wait_ns=50_000_000):
        """What came back, and how long after the request each portion was there."""
        start = self.clock.now_ns()
        self.port.write(packet)
        data, times = b"", []
        while len(data) < size and self.clock.now_ns() < start + wait_ns:
            self.clock.wait_readable([self.port], start + wait_ns)
            portion = self.port.read(self.port.in_waiting)
            if portion:
                data += portion
                times.append((self.clock.now_ns() - start, len(portion)))
        return data, times


def byte_ns(count, baud=4_000_000):
    return count * 10 * 1_000_000_000 // baud


def expiry(time_ns, last_ns=0):
    """First latency timer event, 1 ms apart since the last packet, that is not before a time."""
    return last_ns + -(-(time_ns - last_ns) // LATENCY_NS) * LATENCY_NS


@pytest.mark.parametrize("baud", [4_000_000, 1_000_000, 57_600])
def test_a_ping_takes_its_bytes_turnaround_timer_and_two_transfers(robot, baud):
    code = {4_000_000: 6, 1_000_000: 3, 57_600: 1}[baud]
    made = robot(*QUIET)
    made.servos["left_hip_yaw"].registers[Register.BAUD_RATE] = code
    made.servos["left_hip_yaw"].reboot()
    made.clock.sleep_until_ns(300_000_000)
    client = Client(made, baud=baud)
    start = made.clock.now_ns()
    ((arrived, size),) = client.ask(protocol.encode_instruction(1, 1), 14)[1]
    wire = start + USB_NS + byte_ns(10, baud) + TURNAROUND_NS + byte_ns(14, baud)
    assert size == 14
    assert arrived == expiry(wire) + USB_NS - start


def test_return_delay_time_delays_the_answer(robot):
    made = robot(*QUIET)
    made.servos["left_hip_yaw"].registers[Register.RETURN_DELAY_TIME] = 250
    made.servos["left_hip_yaw"].reboot()
    made.clock.sleep_until_ns(300_000_000)
    client = Client(made)
    ((slow, _),) = client.ask(protocol.encode_instruction(1, 1), 14)[1]
    wire = USB_NS + byte_ns(10) + TURNAROUND_NS + 500_000 + byte_ns(14)
    assert slow == expiry(wire) + USB_NS


def test_full_packets_leave_at_once_and_the_rest_with_the_timer(robot):
    made = robot(*QUIET)
    size = 8 + 6 * 14
    data, times = Client(made).ask(protocol.encode_sync_read(IDS, 126, 10, fast=True), size)
    first_byte = USB_NS + byte_ns(20) + TURNAROUND_NS
    full = first_byte + byte_ns(62)
    assert times == [(full + USB_NS, 62), (full + LATENCY_NS + USB_NS, size - 62)]
    assert len(protocol.decode_fast_status(data, [10] * 6)) == 6


def test_jitter_stays_in_its_bounds_and_is_seeded(robot):
    def arrivals(seed):
        client = Client(robot("usb_jitter_us=100", seed=seed))
        return [client.ask(protocol.encode_instruction(1, 1), 14)[1][0][0] for _ in range(20)]

    assert arrivals(1) == arrivals(1)
    assert arrivals(1) != arrivals(2)


def test_another_baud_gets_no_answer_until_it_is_set_right(robot):
    client = Client(robot(*QUIET), baud=1_000_000)
    assert client.ask(protocol.encode_instruction(1, 1), 14)[0] == b""
    client.port.baudrate = 4_000_000
    assert len(client.ask(protocol.encode_instruction(1, 1), 14)[0]) == 14


def test_what_is_sent_while_servos_talk_is_lost(robot):
    made = robot(*QUIET)
    client = Client(made)
    client.port.write(protocol.encode_sync_read(IDS, 120, 27))
    made.clock.sleep_until_ns(300_000)
    client.port.write(protocol.encode_write(1, Register.LED.address, b"\x01"))
    made.clock.sleep_until_ns(20_000_000)
    assert made.devices["left_leg"].collisions == 1
    assert made.servos["left_hip_yaw"].registers[Register.LED] == 0


def test_goals_act_at_the_first_grid_point_after_their_last_byte(robot):
    made = robot(*QUIET)
    client = Client(made)
    servo = made.world.servos
    client.port.write(protocol.encode_write(1, 64, b"\x01"))
    made.clock.sleep_until_ns(10_000_000)
    packet = protocol.encode_sync_write(116, 4, [(1, (2500).to_bytes(4, "little"))])
    arrival = 10_000_000 + USB_NS + byte_ns(len(packet))
    client.port.write(packet)
    made.clock.sleep_until_ns(arrival - 1)
    assert servo.goal[0] == 2048
    made.clock.sleep_until_ns(arrival)
    assert servo.goal[0] == 2500
    assert servo.duty[0] == 0.0
    made.clock.sleep_until_ns(made.world.grid_time_ns(made.world.substep_index + 1))
    assert servo.duty[0] == 1.0


def test_goals_wait_for_the_computer_but_requests_do_not(robot):
    made = robot(*QUIET, "compute_us=800")
    client = Client(made)
    request = protocol.encode_instruction(1, 1)
    client.ask(request, 14)
    read_ns = made.clock.now_ns()
    packet = protocol.encode_sync_write(116, 4, [(1, (2100).to_bytes(4, "little"))])
    client.port.write(packet)
    arrival = read_ns + 800_000 + USB_NS + byte_ns(len(packet))
    made.clock.sleep_until_ns(arrival - 1)
    assert made.world.servos.goal[0] == 2048
    made.clock.sleep_until_ns(arrival)
    assert made.world.servos.goal[0] == 2100


def test_the_watchdog_stops_a_servo_that_hears_nothing(robot):
    made = robot(*QUIET)
    client = Client(made)
    servo = made.servos["left_hip_yaw"]
    for address, value in ((98, b"\x02"), (64, b"\x01"), (116, (2300).to_bytes(4, "little"))):
        client.ask(protocol.encode_write(1, address, value), 11)
    heard = made.clock.now_ns()
    made.clock.sleep_until_ns(heard + 38_000_000)
    assert made.world.servos.goal[0] == 2300
    made.clock.sleep_until_ns(heard + 41_000_000)
    assert servo.registers[Register.BUS_WATCHDOG] == 255
    assert servo.registers[Register.TORQUE_ENABLE] == 1
    stopped = made.world.servos.goal[0]
    assert stopped == pytest.approx(made.world.servos.counts[0], abs=10)
    refused, _ = client.ask(protocol.encode_write(1, 116, (2048).to_bytes(4, "little")), 11)
    assert refused[8] == protocol.StatusError.DATA_RANGE
    client.port.write(protocol.encode_sync_write(116, 4, [(1, (2048).to_bytes(4, "little"))]))
    made.clock.sleep_until_ns(made.clock.now_ns() + 5_000_000)
    assert made.world.servos.goal[0] == stopped
    client.ask(protocol.encode_write(1, 98, b"\x00"), 11)
    accepted, _ = client.ask(protocol.encode_write(1, 116, (2048).to_bytes(4, "little")), 11)
    assert accepted[8] == 0


def test_any_packet_on_the_bus_feeds_the_watchdog_and_torque_off_needs_none(robot):
    made = robot(*QUIET)
    client = Client(made)
    fed, limp = (made.servos[name] for name in ("left_hip_yaw", "left_hip_roll"))
    client.ask(protocol.encode_write(1, 98, b"\x01"), 11)
    client.ask(protocol.encode_write(2, 98, b"\x01"), 11)
    client.ask(protocol.encode_write(1, 64, b"\x01"), 11)
    for _ in range(10):
        made.clock.sleep_until_ns(made.clock.now_ns() + 10_000_000)
        client.ask(protocol.encode_instruction(3, 1), 14)
    assert fed.registers[Register.BUS_WATCHDOG] == 1
    made.clock.sleep_until_ns(made.clock.now_ns() + 100_000_000)
    assert fed.registers[Register.BUS_WATCHDOG] == 255
    assert limp.registers[Register.BUS_WATCHDOG] == 1


@pytest.mark.parametrize("first", [1, 2], ids=["its own", "a neighbour's"])
def test_a_watchdog_that_is_shortened_while_armed_trips_after_its_new_time(robot, first):
    made = robot(*QUIET)
    client = Client(made)
    client.ask(protocol.encode_write(first, 98, b"\x64"), 11)  # 2 s: a look is planned for then
    for address, value in ((64, b"\x01"), (98, b"\x02")):
        client.ask(protocol.encode_write(1, address, value), 11)
    made.clock.sleep_until_ns(made.clock.now_ns() + 41_000_000)
    assert made.servos["left_hip_yaw"].registers[Register.BUS_WATCHDOG] == 255


def test_the_journal_tells_when_packets_were_heard_and_torque_went(robot):
    made = robot(*QUIET)
    journal = made.journal(made.clock.now_ns)
    client = Client(made)
    for address, value in ((98, b"\x02"), (64, b"\x01")):
        client.ask(protocol.encode_write(1, address, value), 11)
    heard = made.clock.now_ns()
    client.port.write(protocol.encode_instruction(1, 1))
    made.clock.sleep_until_ns(heard + 100_000_000)
    client.port.read(client.port.in_waiting)
    client.ask(protocol.encode_write(1, 64, b"\x00"), 11)
    told = journal.content()
    arrival = heard + USB_NS + byte_ns(10)
    assert told["packets"][2] == (arrival, "left_leg", "heard")
    assert [event[1:] for event in told["deeds"]] == [
        ("left_hip_yaw", "torque on"),
        ("left_hip_yaw", "stopped"),
        ("left_hip_yaw", "torque off"),
    ]
    assert told["deeds"][1][0] == arrival + 40_000_000


def test_a_line_is_held_by_one_and_known_by_name(robot):
    made = robot()
    first = Client(made)
    with pytest.raises(serial.SerialException, match="in use"):
        Client(made)
    first.port.close()
    first.port.close()
    Client(made)
    with pytest.raises(serial.SerialException, match="no virtual port"):
        serial.serial_for_url("virtual://minibiped/left_arm")
    made.close()
    with pytest.raises(serial.SerialException, match="no virtual port"):
        Client(made, "right_leg")
    with pytest.raises(serial.PortNotOpenError):
        first.port.read()


def test_positions_read_are_those_of_the_last_grid_point(robot):
    made = robot(*QUIET)
    client = Client(made)
    made.clock.sleep_until_ns(100_000_000)
    data, _ = client.ask(protocol.encode_sync_read(IDS, 132, 4, fast=True), 56)
    counts = [int.from_bytes(b.data, "little") for b in protocol.decode_fast_status(data, [4] * 6)]
    np.testing.assert_array_equal(counts, made.world.servos.counts[:6])
