"""What a bus carries, against hand-made arithmetic (10 bits a byte)."""

import pytest

from drivers.dynamixel import budget, protocol
from drivers.dynamixel.blocks import WHOLE
from drivers.dynamixel.budget import BusTiming, bus_budget
from hil.errors import InputError

COMPUTE_NS = 800_000


def timing(baud):
    return BusTiming(baud, latency_timer_ns=1_000_000, usb_transfer_ns=125_000)


def test_sizes_are_those_of_real_packets():
    ids = range(1, 13)
    assert budget.sync_read_size(12) == len(protocol.encode_sync_read(ids, 126, 10))
    request = len(protocol.encode_read(1, 64, 83))
    answer = len(protocol.encode_status(1, 0, bytes(83)))
    idle_ns = budget.wire_time_ns(request + answer, 1_000_000) + budget.TURNAROUND_NS
    assert budget.idle_time_ns(WHOLE, 1_000_000) == idle_ns
    goals = [(servo_id, bytes(4)) for servo_id in ids]
    assert budget.sync_write_size(12, 4) == len(protocol.encode_sync_write(116, 4, goals))
    blocks = [protocol.FastBlock(0, servo_id, bytes(10)) for servo_id in ids]
    assert budget.reply_size([10] * 12, fast=True) == len(protocol.encode_fast_status(blocks))
    plain = [protocol.encode_status(servo_id, 0, bytes(10)) for servo_id in ids]
    assert budget.reply_size([10] * 12, fast=False) == sum(map(len, plain))


# 12 servos, 10-byte block at 1 Mbit/s: 2.78 ms plain, 2.02 ms fast; the write 0.74 ms.
def test_wire_times_of_twelve_servos_at_one_megabit():
    request = budget.sync_read_size(12)
    plain = budget.wire_time_ns(request + budget.reply_size([10] * 12, False), 1_000_000)
    fast = budget.wire_time_ns(request + budget.reply_size([10] * 12, True), 1_000_000)
    assert plain == 2_780_000
    assert fast == 2_020_000
    assert budget.wire_time_ns(budget.sync_write_size(12, 4), 1_000_000) == 740_000


def test_a_leg_at_four_megabit_leaves_a_third_of_a_300_hz_period_beside_the_bus():
    leg = bus_budget("left_leg", timing(4_000_000), 6, True, COMPUTE_NS)
    leg.check(300)
    assert leg.bus_ns < 0.7 * 1e9 / 300
    assert leg.highest_rate_hz == 1_000_000_000 // leg.needed_ns > 300


def test_a_rate_that_does_not_fit_is_refused_with_the_one_that_does():
    slow = bus_budget("left_leg", timing(57_600), 6, True, COMPUTE_NS)
    with pytest.raises(InputError) as caught:
        slow.check(300)
    needed_ms = slow.needed_ns * 1e-6
    assert str(caught.value) == (
        f"bus left_leg cannot carry 300 Hz: needs {needed_ms:.2f} ms of 3.33 ms at 57600 baud; "
        f"highest rate {slow.highest_rate_hz} Hz"
    )
    slow.check(slow.highest_rate_hz)


def test_plain_reads_need_more_time_than_fast_ones():
    both = [bus_budget("b", timing(1_000_000), 12, fast, 0).needed_ns for fast in (True, False)]
    assert both[1] - both[0] > 700_000
