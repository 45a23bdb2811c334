"""Faults of one serial line: what happens to packets on their way to the devices and back."""

from collections.abc import Callable, Iterable
from random import Random

from hil.fault_kinds import BOTH, TO_HOST, TO_SERVOS
from sim_backends.latency import wire_time_ns

GARBAGE_BYTES = 16
"""Most random bytes that come before a packet."""

Piece = tuple[int, bytes]
"""Delay [ns] and bytes of a packet, or of what became of it."""


class WireFault:
    """One fault of a line while it is active; every packet is hit with probability `share`."""

    def __init__(self, kind: str, values: tuple[float, ...], random: Random) -> None:
        self.kind = kind
        self._random = random
        share, way = (values[0] if values else 1.0), (values[-1] if len(values) > 1 else BOTH)
        self._share = share
        self._delay_ns = int(values[1] * 1e6) if kind == "delay" else 0
        self._ways = {TO_SERVOS, TO_HOST} if way == BOTH else {way}
        self._change: Callable[[bytes], bytes] = getattr(self, f"_{kind}", bytes)

    def hits(self, way: float) -> bool:
        """Draw whether a packet that goes one way is hit."""
        return way in self._ways and self._random.random() < self._share

    def apply(self, piece: Piece) -> Piece:
        """What a packet becomes that is hit; empty when it is lost."""
        delay_ns, data = piece
        return delay_ns + self._delay_ns, self._change(data) if data else data

    def _drop(self, _: bytes) -> bytes:
        return b""

    def _disconnect(self, _: bytes) -> bytes:
        return b""

    def _flip(self, data: bytes) -> bytes:
        bit = self._random.randrange(8 * len(data))
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        return bytes(changed)

    def _truncate(self, data: bytes) -> bytes:
        return data[: self._random.randrange(len(data))]

    def _duplicate(self, data: bytes) -> bytes:
        return data + data

    def _garbage(self, data: bytes) -> bytes:
        return self._random.randbytes(self._random.randint(1, GARBAGE_BYTES)) + data

    def _collide(self, data: bytes) -> bytes:
        """Both senders pull the open-drain wire low: a bit is 1 where both send 1."""
        other = self._random.randbytes(len(data))
        return bytes(a & b for a, b in zip(data, other, strict=True))


class WireFaults:
    """The faults that are active on one line, in the order in which they began."""

    def __init__(self) -> None:
        self._active: list[WireFault] = []
        self._flaky: list[Callable[[], None]] = []

    def begin(self, fault: WireFault) -> None:
        """From now on packets suffer from it."""
        self._active.append(fault)

    def end(self, fault: WireFault) -> None:
        """It is over."""
        self._active.remove(fault)

    def before_packets(self, draw: Callable[[], None]) -> Callable[[], None]:
        """Have something drawn before the devices get a packet; returns what ends it."""
        self._flaky.append(draw)
        return lambda: self._flaky.remove(draw)

    def draw(self) -> None:
        """The devices get a packet now."""
        for draw in self._flaky:
            draw()

    def to_devices(self, data: bytes) -> Piece:
        """What leaves the host's adapter instead of a packet, and how much later."""
        return self._through((0, data), TO_SERVOS)

    def echoes(self) -> bool:
        """Whether the host receives what it sends now."""
        return any(fault.kind == "echo" and fault.hits(TO_SERVOS) for fault in self._active)

    def to_host(self, segments: Iterable[tuple[int, bytes]], baud: int) -> list[tuple[int, bytes]]:
        """What the adapter receives instead of answers (start [ns], bytes), one after another."""
        free_ns = 0
        changed = []
        for start_ns, data in segments:
            delay_ns, left = self._through((0, data), TO_HOST)
            if left:
                begin_ns = max(start_ns + delay_ns, free_ns)
                free_ns = begin_ns + wire_time_ns(len(left), baud)
                changed.append((begin_ns, left))
        return changed

    def _through(self, piece: Piece, way: float) -> Piece:
        for fault in self._active:
            if fault.kind != "echo" and fault.hits(way):
                piece = fault.apply(piece)
        return piece
