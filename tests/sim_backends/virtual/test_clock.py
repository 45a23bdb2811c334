"""Virtual time: order of events and physics, and what a wait returns for."""

import pytest

from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.host_port import HostPort


@pytest.fixture
def clock(make_plant):
    return VirtualClock(make_plant())


def test_events_happen_in_order_of_time_then_of_scheduling(clock):
    seen = []
    for time_ns, name in ((500, "b"), (100, "a"), (500, "c"), (2_000_000, "d")):
        clock.schedule(time_ns, lambda name=name: seen.append((name, clock.now_ns())))
    clock.sleep_until_ns(2_000_000)
    assert seen == [("a", 100), ("b", 500), ("c", 500), ("d", 2_000_000)]
    assert clock.now_ns() == 2_000_000


def test_physics_is_stepped_on_its_grid(clock):
    clock.sleep_until_ns(833_332)
    assert clock.plant.substep_index == 0
    clock.sleep_until_ns(833_333)
    assert clock.plant.substep_index == 1
    clock.sleep_until_ns(1_000_000_000)
    assert clock.plant.substep_index == 1200


def test_at_a_grid_point_the_physics_comes_first(clock):
    seen = []
    clock.schedule(833_333, lambda: seen.append(clock.plant.substep_index))
    clock.schedule(833_332, lambda: seen.append(clock.plant.substep_index))
    clock.sleep_until_ns(833_333)
    assert seen == [0, 1]


def test_time_never_goes_back(clock):
    clock.sleep_until_ns(1000)
    clock.sleep_until_ns(500)
    seen = []
    clock.schedule(200, lambda: seen.append(clock.now_ns()))
    clock.sleep_until_ns(1500)
    assert seen == [1000]


def test_wait_returns_when_bytes_come_and_not_later(clock):
    port, other = HostPort("a", clock), HostPort("b", clock)
    port.deliver_at(700_000, b"x")
    other.deliver_at(600_000, b"y")

    class Line:
        def __init__(self, port):
            self.port = port

        @property
        def in_waiting(self):
            return len(self.port.received)

    clock.wait_readable([Line(port)], 5_000_000)
    assert clock.now_ns() == 700_000
    clock.wait_readable([Line(port)], 5_000_000)
    assert clock.now_ns() == 700_000
    port.take(1)
    clock.wait_readable([Line(port)], 5_000_000)
    assert clock.now_ns() == 5_000_000
