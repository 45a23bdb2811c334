"""CPU time of the servo hot path against dynamixel-sdk's group classes, on a port that never waits.

Both sides talk to the same in-memory port, which answers every request at once with the same
bytes, so only computing is measured: building the request, parsing and checking the answer, and
turning it into signed current, velocity and position of every servo; then writing goal positions.
"""

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from dynamixel_sdk import GroupSyncRead, GroupSyncWrite, PortHandler, Protocol2PacketHandler

from drivers.dynamixel.blocks import HOT, WHOLE
from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.bus import POLL_EVERY, ServoBus
from drivers.dynamixel.control_table import REALTIME_TICK_MODULUS
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.protocol import (
    FastBlock,
    Instruction,
    PacketReader,
    encode_fast_status,
    encode_status,
)
from drivers.dynamixel.read_plan import FAST_DTYPE, FAST_START, BusServo
from drivers.dynamixel.states import ServoStates
from hil.servo import ServoGoals

REPEATS = 7
CYCLES = 300
GOAL_ADDRESS, GOAL_SIZE = 116, 4
TIMING = BusTiming(baud=4_000_000, latency_timer_ns=1_000_000, usb_transfer_ns=125_000)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table: mean CPU time a cycle [µs], best of several runs."""

    name: str
    ours_us: float
    sdk_classic_us: float
    sdk_fast_us: float

    @property
    def ratio(self) -> float:
        """Ours against the SDK's classic path."""
        return self.ours_us / self.sdk_classic_us


class MemoryPort:
    """Answers group reads at once; swallows writes. Looks like `drivers.dynamixel.port.Port`.

    Behind a silent servo nobody answers, as on a real chain.
    """

    def __init__(self, silent_id: int | None = None) -> None:
        self._silent_id = silent_id
        self.name = "memory"
        self.baud = 4_000_000
        self.stream = self
        self._answers: dict[bytes, bytes] = {}
        self._received = b""

    def write(self, data: bytes) -> int:
        """Take a request and hold its answer ready."""
        request = bytes(data)
        if self._silent_id is not None:
            milliseconds = time.monotonic_ns() // 1_000_000
            self._received = _answer(request, milliseconds, self._silent_id)
            return len(request)
        if request not in self._answers:
            self._answers[request] = _answer(request)
        self._received = self._answers[request]
        return len(request)

    @property
    def in_waiting(self) -> int:
        """Bytes of the answer that are left."""
        return len(self._received)

    def fileno(self) -> int:
        """There is no file."""
        return -1

    def read_available(self) -> bytes:
        """The whole answer."""
        data, self._received = self._received, b""
        return data

    def read(self, size: int) -> bytes:
        """The next bytes of the answer."""
        data, self._received = self._received[:size], self._received[size:]
        return data

    def discard_input(self) -> int:
        """Forget the answer."""
        self._received = b""
        return 0


class MemoryHandler(PortHandler):  # type: ignore[misc]  # the SDK has no types
    """The SDK's view of a MemoryPort."""

    def __init__(self, port: MemoryPort) -> None:
        super().__init__("memory")
        self._memory = port
        self.tx_time_per_byte = 0.0025

    def clearPort(self) -> None:
        """Forget the answer."""
        self._memory.discard_input()

    def readPort(self, length: int) -> bytes:
        """The next bytes of the answer."""
        return self._memory.read(length)

    def writePort(self, packet: list[int]) -> int:
        """Send a request."""
        return self._memory.write(bytes(packet))


def _answer(request: bytes, milliseconds: int = 0, silent_id: int | None = None) -> bytes:
    """What servos answer: but for their clocks every byte is 0, so nothing needs stuffing."""
    reader = PacketReader()
    blocks: list[FastBlock] = []
    fast = False
    for packet in reader.feed(request):
        params = packet.params
        fast = packet.instruction == Instruction.FAST_SYNC_READ
        if packet.instruction in (Instruction.SYNC_READ, Instruction.FAST_SYNC_READ):
            tick = (milliseconds % REALTIME_TICK_MODULUS).to_bytes(2, "little")
            data = tick + bytes(int.from_bytes(params[2:4], "little") - 2)
            blocks = [FastBlock(0, servo_id, data) for servo_id in params[4:]]
        elif packet.instruction == Instruction.READ:
            blocks = [FastBlock(0, packet.id, bytes(int.from_bytes(params[2:4], "little")))]
    ids = [block.id for block in blocks]
    heard = blocks[: ids.index(silent_id)] if silent_id in ids else blocks
    if fast:
        return encode_fast_status(blocks)[: FAST_START + len(heard) * FAST_DTYPE.itemsize]
    blocks = heard
    return b"".join(encode_status(block.id, block.error, block.data) for block in blocks)


def _signed(value: int, bits: int) -> int:
    return value - (1 << bits) if value >> (bits - 1) else value


def _ours(servos: int) -> tuple[Callable[[], None], Callable[[], None]]:
    port = MemoryPort()
    states = ServoStates.empty(servos)
    members = [BusServo(index + 1, index) for index in range(servos)]
    idle = IdleReader([servo.id for servo in members], (WHOLE,), TIMING.baud)
    bus = ServoBus("memory", port, TIMING, members, states, True, idle)  # type: ignore[arg-type]
    goals = ServoGoals(
        position=np.full(servos, 2048),
        p_gain=np.full(servos, 800),
        d_gain=np.zeros(servos, dtype=np.int64),
        pwm_limit=np.full(servos, 885),
    )

    def read() -> None:
        bus.begin_read(0)
        bus.collect()
        bus.finish_read()

    def write() -> None:
        goals.position[:] = 2049
        bus.write(goals, 1_000_000_000)

    for _ in range(POLL_EVERY * servos + 1):
        read()
        write()
    if not np.isfinite(states.voltage).all() or bus.counters.stale:
        raise RuntimeError("the in-memory bus was not read as it should be")
    return read, write


def _sdk(servos: int, fast: bool) -> tuple[Callable[[], None], Callable[[], None]]:
    handler = MemoryHandler(MemoryPort())
    packets = Protocol2PacketHandler()
    reader = GroupSyncRead(handler, packets, HOT.address, HOT.length)
    writer = GroupSyncWrite(handler, packets, GOAL_ADDRESS, GOAL_SIZE)
    for servo_id in range(1, servos + 1):
        reader.addParam(servo_id)
        writer.addParam(servo_id, [0, 8, 0, 0])

    def read() -> None:
        if (reader.fastSyncRead() if fast else reader.txRxPacket()) != 0:
            raise RuntimeError("the SDK did not read the in-memory bus")
        for servo_id in range(1, servos + 1):
            _signed(reader.getData(servo_id, 126, 2), 16)
            _signed(reader.getData(servo_id, 128, 4), 32)
            _signed(reader.getData(servo_id, 132, 4), 32)

    def write() -> None:
        for servo_id in range(1, servos + 1):
            writer.changeParam(servo_id, [1, 8, 0, 0])
        writer.txPacket()

    return read, write


def _time_us(*calls: Callable[[], None]) -> float:
    """Mean time of calling all of them once, best of several runs [µs]."""
    best = float("inf")
    gc.disable()
    for _ in range(REPEATS):
        start = time.process_time_ns()
        for _ in range(CYCLES):
            for call in calls:
                call()
        best = min(best, (time.process_time_ns() - start) / CYCLES / 1000)
    gc.enable()
    return best


def measure_hot_path() -> list[Row]:
    """The table; takes some seconds."""
    rows = []
    for servos in (6, 12, 20):
        sides = (_ours(servos), _sdk(servos, fast=False), _sdk(servos, fast=True))
        reads = [_time_us(read) for read, _ in sides]
        cycles = [_time_us(read, write) for read, write in sides]
        rows.append(Row(f"read {servos} servos", *reads))
        rows.append(Row(f"read and write {servos} servos", *cycles))
    return rows
