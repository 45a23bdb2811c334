"""Torque off on every bus of a robot, whatever state its wires are in."""

from collections.abc import Sequence
from contextlib import suppress

from drivers.dynamixel.power import BusPower
from hil.errors import BackendError
from hil.interface import Clock

FRAMES, EVERY_NS = 4, 1_000_000
"""Torque-off frames that go out before one is read back: an answer of all servos of a leg, which
may be under way, takes less than 3 ms even at 1 Mbit/s."""


def send_off(buses: Sequence[BusPower], clock: Clock) -> None:
    """Every bus gets its frames before any is waited for, and again.

    A stop may come while servos answer, and what they talk into is lost.
    """
    for _ in range(FRAMES):
        for bus in buses:
            with suppress(BackendError):
                bus.send_off()
        clock.sleep_until_ns(clock.now_ns() + EVERY_NS)


def switch_off(buses: Sequence[BusPower], clock: Clock) -> None:
    """Torque off, read back where somebody answers: what the guardian does."""
    send_off(buses, clock)
    for bus in buses:
        with suppress(BackendError):
            bus.off()
