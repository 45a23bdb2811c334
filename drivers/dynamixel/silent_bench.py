"""One silent servo among many: what a group read costs then, ours and dynamixel-sdk's.

Both sides wait as they would on a real port, on one in memory whose chain ends at that servo.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from dynamixel_sdk import GroupSyncRead, Protocol2PacketHandler

from drivers.dynamixel.blocks import HOT, WHOLE
from drivers.dynamixel.bus import ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.hot_path_bench import REPEATS, TIMING, MemoryHandler, MemoryPort
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.states import ServoStates
from hil.interface import Readable


@dataclass(frozen=True, slots=True)
class SilentRow:
    """What one silent servo among many costs a group read."""

    name: str
    first_ms: float
    """Wall time of the cycle in which it falls silent."""
    first_cpu_ms: float
    later_ms: float
    """Wall time of a cycle after that, mean of several."""
    heard: int
    """Servos that are heard in those."""


class _WallClock:
    """Real time for a port without a file: waiting is sleeping, as in select."""

    def now_ns(self) -> int:
        """Current time [ns]."""
        return time.monotonic_ns()

    def sleep_until_ns(self, time_ns: int) -> None:
        """Sleep."""
        time.sleep(max(0, time_ns - time.monotonic_ns()) * 1e-9)

    def wait_readable(self, ports: Sequence[Readable], deadline_ns: int) -> None:
        """Wait for bytes that never come."""
        if not any(port.in_waiting for port in ports):
            self.sleep_until_ns(deadline_ns)


def measure_silent(servos: int = 12) -> list[SilentRow]:
    """One servo in the middle of the chain falls silent: ours, and the SDK's two ways; best of
    several runs each."""
    runs = [_measure_silent_once(servos, later=10) for _ in range(REPEATS)]
    return [min(rows, key=lambda row: row.first_ms) for rows in zip(*runs, strict=True)]


def _measure_silent_once(servos: int, later: int) -> list[SilentRow]:
    port, states = MemoryPort(servos // 2), ServoStates.empty(servos)
    members = [BusServo(index + 1, index) for index in range(servos)]
    idle = IdleReader([servo.id for servo in members], (WHOLE,), TIMING.baud)
    bus = ServoBus("memory", port, TIMING, members, states, True, idle)  # type: ignore[arg-type]
    group = BusGroup([bus], _WallClock())

    def ours() -> int:
        states.valid[:] = False
        group.send_reads()
        group.receive()
        return int(states.valid.sum())

    def theirs(fast: bool) -> Callable[[], int]:
        packets = Protocol2PacketHandler()
        handler = MemoryHandler(MemoryPort(servos // 2))
        reader = GroupSyncRead(handler, packets, HOT.address, HOT.length)
        for servo in members:
            reader.addParam(servo.id)

        def read() -> int:
            _ = reader.fastSyncRead() if fast else reader.txRxPacket()
            return sum(reader.isAvailable(servo.id, 132, 4) for servo in members)

        return read

    sides = {"ours": ours, "SDK, classic": theirs(False), "SDK, fast": theirs(True)}
    return [_time_silent(name, read, later) for name, read in sides.items()]


def _time_silent(name: str, read: Callable[[], int], later: int) -> SilentRow:
    wall, cpu = time.monotonic_ns(), time.thread_time_ns()
    read()
    first_ms = (time.monotonic_ns() - wall) * 1e-6
    first_cpu_ms = (time.thread_time_ns() - cpu) * 1e-6
    read()  # In this one a doubtful servo is asked once more.
    wall = time.monotonic_ns()
    heard = [read() for _ in range(later)]
    later_ms = (time.monotonic_ns() - wall) * 1e-6 / later
    return SilentRow(name, first_ms, first_cpu_ms, later_ms, min(heard))
