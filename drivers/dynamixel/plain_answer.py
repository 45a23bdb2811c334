"""The answer to a plain group read: one status packet of each servo, one after another."""

from drivers.dynamixel.protocol import FastBlock, PacketReader
from drivers.dynamixel.read_plan import ReadPlan
from drivers.dynamixel.realtime_ticks import Verdict
from drivers.dynamixel.state_filler import StateFiller


class PlainAnswer:
    """Takes status packets until the last of the chain has answered, or all others.

    A packet that was lost on the way to the host does not silence those behind it. Those of an
    earlier tick are told by the servos' clocks: they are better than none, and end no waiting.
    """

    def __init__(self, filler: StateFiller) -> None:
        self.late = 0
        """Packets of an earlier tick's answer."""
        self.damaged = 0
        """Packets with a wrong CRC."""
        self._filler = filler
        self._reader = PacketReader()
        self._ids: tuple[int, ...] = ()

    def begin(self, plan: ReadPlan, sample_ns: int) -> None:
        """Expect the answer to a request whose servos sample at a time [ns]."""
        self._filler.begin(sample_ns)
        self._reader.reset()
        self._ids = plan.ids
        self.late = self.damaged = 0

    def take(self, data: bytes) -> bool:
        """Take received bytes; True when the answer is complete."""
        errors = self._reader.crc_errors
        packets = self._reader.feed(data)
        self.damaged += self._reader.crc_errors - errors
        complete = False
        for packet in packets:
            if not packet.is_status or packet.id not in self._ids:
                continue
            verdict = self._filler.take(FastBlock(packet.error, packet.id, packet.data))
            if verdict in (Verdict.LATE, Verdict.REPEATED):
                self.late += 1
            elif packet.id == self._ids[-1]:
                complete = True
        return complete

    def finish(self) -> None:
        """Nothing is left to save."""
