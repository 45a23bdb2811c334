"""Reads in idle time: behind the writes of a tick one servo is asked for its slow registers.

Nobody waits for the answer: it is found among the bytes that are there in the next tick. So a
servo that does not answer costs nothing, and this is the way to look for lost ones too.
"""

from collections.abc import Sequence
from typing import NamedTuple

from drivers.dynamixel.blocks import IN_TURN, WHOLE, Block, SlowRegisters, decode_slow
from drivers.dynamixel.budget import idle_time_ns
from drivers.dynamixel.protocol import ERROR_MASK, Packet, PacketReader, encode_read


class IdleAnswer(NamedTuple):
    """One servo's answer."""

    place: int
    error: int
    """Error byte."""
    found: SlowRegisters


def idle_blocks(spare_ns: int, baud: int) -> tuple[Block, ...]:
    """What fits into the time that is left of a tick: all at once, or short blocks in turn."""
    return (WHOLE,) if idle_time_ns(WHOLE, baud) <= spare_ns else IN_TURN


class IdleReader:
    """Asks the servos of a bus in turn, or one out of turn."""

    def __init__(self, ids: Sequence[int], blocks: Sequence[Block], baud: int) -> None:
        self.duration_ns = max(idle_time_ns(block, baud) for block in blocks)
        """Time on the wire, request and answer."""
        self._ids = tuple(ids)
        self._blocks = tuple(blocks)
        self._requests = [
            [encode_read(servo_id, block.address, block.length) for block in blocks]
            for servo_id in ids
        ]
        self._turn = 0
        self._reader = PacketReader()
        self._pending: tuple[int, Block] | None = None

    @property
    def waiting(self) -> bool:
        """An answer may be under way."""
        return self._pending is not None

    def next_request(self) -> bytes:
        """The read of the servo and block whose turn it is."""
        turn, part = divmod(self._turn, len(self._blocks))
        self._turn += 1
        return self._ask(turn % len(self._ids), part)

    def request(self, place: int) -> bytes:
        """The read of one servo's state."""
        return self._ask(place, 0)

    def take(self, data: bytes) -> IdleAnswer | None:
        """Look for the answer among received bytes."""
        answers = [self.match(packet) for packet in self._reader.feed(data)]
        return next((answer for answer in answers if answer is not None), None)

    def match(self, packet: Packet) -> IdleAnswer | None:
        """The answer, if this packet is it."""
        if self._pending is None or not packet.is_status:
            return None
        place, block = self._pending
        if packet.id != self._ids[place] or len(packet.data) != block.length:
            return None
        self._pending = None
        if packet.error & ERROR_MASK:
            return None
        return IdleAnswer(place, packet.error, decode_slow(block, packet.data))

    def forget(self) -> None:
        """Take no answer to what was asked before."""
        self._pending = None

    def _ask(self, place: int, part: int) -> bytes:
        self._pending = place, self._blocks[part]
        self._reader.reset()
        return self._requests[place][part]
