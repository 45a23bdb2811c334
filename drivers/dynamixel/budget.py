"""What a servo bus can carry: bytes, baud and adapter latency to time, as pure functions.

One tick of a bus: a read request, the replies, the controller's compute time, the writes, and a
read in idle time that nobody waits for. The group read ends when the last reply byte is in the
host, which the USB adapter's latency timer may hold back by its whole period. Ten bits a byte on
the wire.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from drivers.dynamixel.blocks import HOT, IN_TURN, Block
from drivers.dynamixel.protocol import FAST_BLOCK_OVERHEAD, PREFIX_SIZE
from hil.errors import InputError

BITS_PER_BYTE = 10
TURNAROUND_NS = 20_000
"""From the end of a packet to the first byte of its answer, a servo with Return Delay Time 0
(assumed; 50 µs was reported for MX servos)."""
_INSTRUCTION_SIZE = PREFIX_SIZE + 3
_STATUS_OVERHEAD = PREFIX_SIZE + 4
_SYNC_HEAD = 4
_READ_PARAMS = 4
_GOAL_SIZE = 4


def wire_time_ns(size: int, baud: int) -> int:
    """Time of `size` bytes on the wire [ns]."""
    return size * BITS_PER_BYTE * 1_000_000_000 // baud


def sync_read_size(servos: int) -> int:
    """Bytes of a (fast) sync read request."""
    return _INSTRUCTION_SIZE + _SYNC_HEAD + servos


def sync_write_size(servos: int, length: int) -> int:
    """Bytes of a sync write of `length` data bytes a servo."""
    return _INSTRUCTION_SIZE + _SYNC_HEAD + servos * (1 + length)


def reply_size(lengths: Sequence[int], fast: bool) -> int:
    """Bytes of the answer to a group read, without stuffing."""
    if fast:
        return PREFIX_SIZE + 1 + sum(FAST_BLOCK_OVERHEAD + length for length in lengths)
    return sum(_STATUS_OVERHEAD + length for length in lengths)


def idle_time_ns(block: Block, baud: int) -> int:
    """From the first byte of a read of one servo to the last one of its answer [ns]."""
    size = _INSTRUCTION_SIZE + _READ_PARAMS + _STATUS_OVERHEAD + block.length
    return wire_time_ns(size, baud) + TURNAROUND_NS


@dataclass(frozen=True, slots=True)
class BusTiming:
    """Speed and delays of one bus and its adapter."""

    baud: int
    latency_timer_ns: int
    usb_transfer_ns: int

    def read_time_ns(self, request: int, reply: int, servos: int, fast: bool) -> int:
        """From the first request byte written to the last reply byte read, at worst [ns]."""
        turnarounds = TURNAROUND_NS * (servos if not fast else 1)
        return (
            2 * self.usb_transfer_ns
            + wire_time_ns(request + reply, self.baud)
            + turnarounds
            + self.latency_timer_ns
        )

    def write_time_ns(self, size: int) -> int:
        """From the first byte written to the last byte on the wire [ns]."""
        return self.usb_transfer_ns + wire_time_ns(size, self.baud)


@dataclass(frozen=True, slots=True)
class BusBudget:
    """One bus's worst tick."""

    bus: str
    timing: BusTiming
    read_ns: int
    compute_ns: int
    write_ns: int
    idle_ns: int
    """The longest of the shortest reads in idle time."""

    @property
    def bus_ns(self) -> int:
        """Time that reading and writing take, the adapter's latency included [ns]."""
        return self.read_ns + self.write_ns + self.idle_ns

    @property
    def needed_ns(self) -> int:
        """Time that one whole tick takes, the controller's compute time included [ns]."""
        return self.bus_ns + self.compute_ns

    @property
    def highest_rate_hz(self) -> int:
        """The highest whole rate at which a tick fits its period."""
        return 1_000_000_000 // self.needed_ns

    def slack_ns(self, rate_hz: int) -> int:
        """Time of the period that is left over; negative when the rate cannot be carried [ns]."""
        return 1_000_000_000 // rate_hz - self.needed_ns

    def check(self, rate_hz: int) -> None:
        """Raises InputError when the bus cannot carry the rate."""
        if self.needed_ns * rate_hz <= 1_000_000_000:
            return
        raise InputError(
            f"bus {self.bus} cannot carry {rate_hz} Hz: needs {self.needed_ns * 1e-6:.2f} ms of "
            f"{1e3 / rate_hz:.2f} ms at {self.timing.baud} baud; "
            f"highest rate {self.highest_rate_hz} Hz"
        )


def bus_budget(bus: str, timing: BusTiming, servos: int, fast: bool, compute_ns: int) -> BusBudget:
    """Budget of a bus on which all servos are read and written, and one is asked in idle time."""
    reply = reply_size([HOT.length] * servos, fast)
    return BusBudget(
        bus=bus,
        timing=timing,
        read_ns=timing.read_time_ns(sync_read_size(servos), reply, servos, fast),
        compute_ns=compute_ns,
        write_ns=timing.write_time_ns(sync_write_size(servos, _GOAL_SIZE)),
        idle_ns=max(idle_time_ns(block, timing.baud) for block in IN_TURN),
    )
