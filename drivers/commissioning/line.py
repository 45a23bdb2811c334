"""One port with servos on it, asked packet by packet, and heard with suspicion."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from drivers.dynamixel.budget import BusTiming, reply_size, wire_time_ns
from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.port import Port
from drivers.dynamixel.power import BusPower
from drivers.dynamixel.protocol import (
    BROADCAST_ID,
    ERROR_MASK,
    Instruction,
    Packet,
    PacketReader,
    encode_instruction,
    encode_read,
    encode_write,
)
from hil.interface import Clock

FACTORY_LATENCY_NS = 16_000_000
"""Latency timer of an FTDI adapter that nobody has set."""
USB_TRANSFER_NS = 1_000_000
"""One full-speed USB frame."""
MARGIN_NS = 10_000_000
"""Return Delay Time as it leaves the factory and the host's wake-up (assumed)."""
PING_SLOT_NS = 3_000_000
"""A broadcast ping leaves every id 3 ms (dynamixel-sdk, broadcastPing)."""
QUIET_NS = 25_000_000
"""A line that says nothing for so long has said everything: a latency timer and some margin."""
_PING_SIZE = 14
_BLOCK_ATTEMPTS = 2


@dataclass(slots=True)
class Heard:
    """What came back."""

    packets: list[Packet] = field(default_factory=list)
    garbled: bool = False
    """There were bytes that belong to no valid packet."""


class ServoLine:
    """Blocking access to one port at any speed.

    Answers are awaited as if the adapter held them back for 16 ms; what is whole is taken at once.
    """

    def __init__(self, port: Port, clock: Clock) -> None:
        self.port = port
        self.clock = clock

    @property
    def timing(self) -> BusTiming:
        """Speed and delays, as pessimistic as an unknown adapter deserves."""
        return BusTiming(self.port.baud, FACTORY_LATENCY_NS, USB_TRANSFER_NS)

    @property
    def client(self) -> ServoClient:
        """Single registers at the present speed."""
        return ServoClient(self.port, self.timing, self.clock)

    def power(self, ids: Iterable[int]) -> BusPower:
        """Torque of some servos at the present speed."""
        group = GroupAccess(self.port, self.timing, self.clock)
        return BusPower(self.port.name, group, list(ids))

    def ping_all(self) -> Heard:
        """Everybody who answers a broadcast ping at the present speed; takes 0.8 s."""
        slots_ns = (BROADCAST_ID + 1) * PING_SLOT_NS
        wait_ns = slots_ns + wire_time_ns(2 * _PING_SIZE, self.port.baud) + QUIET_NS
        packet = encode_instruction(BROADCAST_ID, Instruction.PING)
        return self._ask(packet, wait_ns, lambda _: False)

    def ping(self, servo_id: int) -> Heard:
        """One servo's answer to one ping."""
        packet = encode_instruction(servo_id, Instruction.PING)
        return self._ask(packet, self._wait_ns(2 * _PING_SIZE), lambda got: got.id == servo_id)

    def read_block(self, servo_id: int, begin: Register, end: Register) -> bytes | None:
        """The registers from `begin` to `end`; None if the servo does not tell."""
        for _ in range(_BLOCK_ATTEMPTS):
            data, _ = self.hear_block(servo_id, begin, end)
            if data is not None:
                return data
        return None

    def hear_block(
        self, servo_id: int, begin: Register, end: Register
    ) -> tuple[bytes | None, bool]:
        """One try of `read_block`, and whether anything else was heard."""
        length = end.end - begin.address
        request = encode_read(servo_id, begin.address, length)
        wait_ns = self._wait_ns(len(request) + reply_size([length], fast=False))

        def answers(packet: Packet) -> bool:
            """A late answer to something else, such as a ping, is not this one's."""
            refused = bool(packet.error & ERROR_MASK)
            return packet.id == servo_id and (refused or len(packet.data) == length)

        heard = self._ask(request, wait_ns, answers)
        for packet in filter(answers, heard.packets):
            if not packet.error & ERROR_MASK:
                return packet.data, heard.garbled or len(heard.packets) > 1
        return None, heard.garbled or bool(heard.packets)

    def tell(self, servo_id: int, register: Register, value: int) -> None:
        """Write a register and expect no answer: to everybody, or where speed or id change."""
        packet = encode_write(servo_id, register.address, register.spec.encode(value))
        self._ask(packet, self._wait_ns(2 * len(packet)), lambda _: True)

    def close(self) -> None:
        """Close the port."""
        self.port.close()

    def _wait_ns(self, size: int) -> int:
        return (
            wire_time_ns(size, self.port.baud) + FACTORY_LATENCY_NS + 2 * USB_TRANSFER_NS
            + MARGIN_NS
        )  # fmt: skip

    def _ask(self, packet: bytes, wait_ns: int, enough: Callable[[Packet], bool]) -> Heard:
        """Send and listen until the deadline, or until a packet is enough."""
        port, clock = self.port, self.clock
        port.discard_input()
        port.write(packet)
        deadline_ns = clock.now_ns() + wait_ns
        reader, heard = PacketReader(), Heard()
        while clock.now_ns() < deadline_ns:
            clock.wait_readable([port.stream], deadline_ns)
            data = port.read_available()
            if data:
                deadline_ns = max(deadline_ns, clock.now_ns() + QUIET_NS)
            found = [got for got in reader.feed(data) if got.is_status]
            heard.packets += found
            if any(map(enough, found)):
                break
        heard.garbled = bool(reader.crc_errors or reader.skipped_bytes or reader.pending)
        return heard


def value_in(block: bytes, begin: Register, register: Register) -> int:
    """A register's value in a block that starts at `begin`."""
    first = register.address - begin.address
    return register.spec.decode(block[first : first + register.size])
