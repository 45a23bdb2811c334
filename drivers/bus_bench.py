"""What one servo bus achieves: cycles of group read and group write, one after another.

Nothing moves: the write puts Profile Velocity, which is as long as a goal, to what it is already.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass

import numpy as np

from drivers.assembly import open_bus, port_url
from drivers.dynamixel.blocks import HOT, WHOLE
from drivers.dynamixel.budget import (
    TURNAROUND_NS,
    BusTiming,
    reply_size,
    sync_read_size,
    sync_write_size,
    wire_time_ns,
)
from drivers.dynamixel.bus import ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import RETURN_DELAY_UNIT_NS, Register
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.port import Port
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.servo_models import SERVO_MODELS
from drivers.dynamixel.states import ServoStates
from hil.clock import MonotonicClock
from hil.description import RobotDescription
from hil.errors import BackendError
from hil.interface import Clock, Floats

WARM_UP = 20
PLANNED_LATENCY_MS = 1
"""Latency timer of an adapter whose driver does not tell it."""
USB_TRANSFER_NS = 125_000
"""One high-speed USB microframe."""
MARGIN_NS = 5_000_000
"""Waiting beyond what an answer should take: slow ones are to be measured, not cut off."""


@dataclass(frozen=True, slots=True)
class BusMeasurement:
    """One bus under load."""

    bus: str
    baud: int
    servos: int
    fast: bool
    """Fast reads were used."""
    cycle_ms: Floats
    """Duration of each cycle, shape (cycles,)."""
    timeouts: int
    crc_errors: int
    lost_pct: float
    """Servo samples that did not arrive."""
    parts_ms: dict[str, float]
    """What a mean cycle is made of; `waiting` is what nothing explains."""

    @property
    def rate_hz(self) -> float:
        """Rate that 99 of 100 cycles can follow."""
        return float(1e3 / np.percentile(self.cycle_ms, 99))

    @property
    def limit(self) -> str:
        """The part that takes most of the cycle."""
        return max(self.parts_ms, key=self.parts_ms.__getitem__)


def measure_bus(
    port: Port,
    timing: BusTiming,
    clock: Clock,
    ids: Sequence[int],
    cycles: int,
    compute_ns: int = 0,
) -> BusMeasurement:
    """Load a bus, without `ids` all servos that answer a scan. Raises BackendError.

    `compute_ns`: what a virtual host waits between reading and writing; its own time is none.
    """
    client, access = ServoClient(port, timing, clock), GroupAccess(port, timing, clock)
    found = {k: v for k, v in client.scan().items() if not ids or k in ids}
    missing = [str(servo_id) for servo_id in ids if servo_id not in found]
    if missing or not found:
        raise BackendError(f"bus {port.name}: id {', '.join(missing) or 'any'} does not answer")
    members = sorted(found)
    fast = all(_knows_fast_reads(*found[servo_id]) for servo_id in members)
    delays = access.read(Register.RETURN_DELAY_TIME, members)
    profile = access.read(Register.PROFILE_VELOCITY, members)
    states = ServoStates.empty(len(members))
    servos = [BusServo(servo_id, index) for index, servo_id in enumerate(members)]
    idle = IdleReader(members, (WHOLE,), timing.baud)
    bus = ServoBus(port.name, port, timing, servos, states, fast, idle, MARGIN_NS)
    group = BusGroup([bus], clock)

    def cycle() -> None:
        group.send_reads()
        group.receive()
        access.write(Register.PROFILE_VELOCITY, profile)

    for _ in range(WARM_UP):
        cycle()
    before = bus.counters.timeouts, bus.counters.crc_errors, bus.counters.stale
    cycle_ms, cpu_ms = _time(cycle, clock, cycles)
    delay_ns = sum(delays.values()) * RETURN_DELAY_UNIT_NS
    return BusMeasurement(
        bus=port.name,
        baud=timing.baud,
        servos=len(members),
        fast=bus.fast,
        cycle_ms=cycle_ms,
        timeouts=bus.counters.timeouts - before[0],
        crc_errors=bus.counters.crc_errors - before[1],
        lost_pct=100 * (bus.counters.stale - before[2]) / (cycles * len(members)),
        parts_ms=_parts(
            timing,
            len(members),
            bus.fast,
            delay_ns,
            {"planned computing": compute_ns * 1e-6} if compute_ns else {"host CPU": cpu_ms},
            float(cycle_ms.mean()),
        ),
    )


def measure_robot(
    description: RobotDescription, clock: Clock, port_urls: Mapping[str, str], cycles: int
) -> list[BusMeasurement]:
    """Load every bus of a robot, one after another. Raises PortError or BackendError."""
    rows = []
    real = isinstance(clock, MonotonicClock)
    compute_ns = 0 if real else 1000 * description.timing.compute_us
    for name in description.buses:
        part = open_bus(description, clock, name, port_url(port_urls, name))
        with closing(part.port):
            ids = [servo.id for servo in part.servos]
            rows.append(measure_bus(part.port, part.timing, clock, ids, cycles, compute_ns))
    return rows


def measure_port(
    url: str, baud: int, ids: Sequence[int], clock: Clock, cycles: int
) -> BusMeasurement:
    """Load the bus at a port. Raises PortError or BackendError."""
    with closing(Port("bus", url, baud)) as port:
        latency_ms = port.latency_timer_ms or PLANNED_LATENCY_MS
        timing = BusTiming(baud, latency_ms * 1_000_000, USB_TRANSFER_NS)
        return measure_bus(port, timing, clock, ids, cycles)


def _time(cycle: Callable[[], None], clock: Clock, cycles: int) -> tuple[Floats, float]:
    """Durations of cycles on the clock, and mean CPU time of one [ms]."""
    times = np.zeros(cycles + 1, dtype=np.int64)
    cpu_ns = time.thread_time_ns()
    for k in range(cycles):
        times[k] = clock.now_ns()
        cycle()
    times[cycles] = clock.now_ns()
    return np.diff(times) * 1e-6, (time.thread_time_ns() - cpu_ns) * 1e-6 / cycles


def _parts(
    timing: BusTiming,
    servos: int,
    fast: bool,
    delay_ns: int,
    host_ms: dict[str, float],
    mean_ms: float,
) -> dict[str, float]:
    size = sync_read_size(servos) + reply_size([HOT.length] * servos, fast)
    turnarounds = TURNAROUND_NS * (1 if fast else servos)
    parts = {
        "bytes on the wire": wire_time_ns(size + sync_write_size(servos, 4), timing.baud) * 1e-6,
        "latency timer": timing.latency_timer_ns * 1e-6,
        "USB transfers": 2 * timing.usb_transfer_ns * 1e-6,
        "return delay": delay_ns * 1e-6 / (servos if fast else 1),
        "turnaround": turnarounds * 1e-6,
        **host_ms,
    }
    return {**parts, "waiting": max(0.0, mean_ms - sum(parts.values()))}


def _knows_fast_reads(number: int, firmware: int) -> bool:
    models = [model for model in SERVO_MODELS.values() if model.number == number]
    return any(
        model.fast_read_firmware is not None and firmware >= model.fast_read_firmware
        for model in models
    )
