"""A dynamixel-sdk PortHandler on our Port and Clock, for everything off the hot path.

The SDK's own handler opens the port shared, polls the wall clock, and waits at least 34 ms for
whoever does not answer. This one has none of that, and it mends what the SDK's packet handler
gets wrong on the way out: `txPacket` computes stuffing and then sends the packet without it.
"""

from dynamixel_sdk import PortHandler

from drivers.dynamixel.budget import BusTiming, wire_time_ns
from drivers.dynamixel.port import Port
from drivers.dynamixel.protocol import PREFIX_SIZE, encode_instruction
from hil.interface import Clock

ANSWER_MARGIN_NS = 20_000_000
"""Beyond wire and adapter: Return Delay Time as it leaves the factory, EEPROM writes, host wake-up
(assumed; a missing servo costs this much each time it is asked)."""


class SdkPort(PortHandler):  # type: ignore[misc]
    """What the SDK calls a port. Reads wait on the Clock, up to a deadline from bytes and baud."""

    def __init__(self, port: Port, timing: BusTiming, clock: Clock) -> None:
        super().__init__(port.url)
        self._port = port
        self._timing = timing
        self._clock = clock
        self._buffer = b""
        self._deadline_ns = 0
        self._request_size = 0
        self.is_open = True
        self.baudrate = port.baud

    @property
    def is_using(self) -> bool:
        """The SDK's lock, which it leaves set after an exception: one thread needs none."""
        return False

    @is_using.setter
    def is_using(self, value: bool) -> None:
        """Ignored."""

    def clearPort(self) -> None:
        """Discard what was received."""
        self._buffer = b""
        self._port.discard_input()

    def getBytesAvailable(self) -> int:
        """Bytes that `readPort` returns at once."""
        self._buffer += self._port.read_available()
        return len(self._buffer)

    def readPort(self, length: int) -> bytes:
        """Up to `length` bytes; waits for the first of them until the deadline."""
        if not self._buffer:
            self._clock.wait_readable([self._port.stream], self._deadline_ns)
        if len(self._buffer) < length:
            self._buffer += self._port.read_available()
        data, self._buffer = self._buffer[:length], self._buffer[length:]
        return data

    def writePort(self, packet: list[int]) -> int:
        """Send an SDK packet, stuffed as the protocol demands."""
        raw = bytes(packet)
        body = raw[PREFIX_SIZE:-2]
        self._port.write(encode_instruction(raw[4], body[0], body[1:]))
        self._request_size = len(raw)
        return len(raw)

    def setPacketTimeout(self, packet_length: int) -> None:
        """Deadline for an answer of `packet_length` bytes to a packet sent just now."""
        timing = self._timing
        self._deadline_ns = (
            self._clock.now_ns()
            + wire_time_ns(self._request_size + packet_length, self._port.baud)
            + timing.latency_timer_ns
            + 2 * timing.usb_transfer_ns
            + ANSWER_MARGIN_NS
        )

    def setPacketTimeoutMillis(self, msec: float) -> None:
        """Deadline from now [ms]; the SDK's broadcast ping uses it."""
        self._deadline_ns = self._clock.now_ns() + int(msec * 1e6) + ANSWER_MARGIN_NS

    def isPacketTimeout(self) -> bool:
        """Whether the deadline has come."""
        return self._clock.now_ns() >= self._deadline_ns

    def setBaudRate(self, baudrate: int) -> bool:
        """Change the speed [bit/s], 4.5 Mbit/s included."""
        self._port.set_baud(baudrate)
        self.baudrate = baudrate
        return True

    def closePort(self) -> None:
        """Close our port."""
        self._port.close()
        self.is_open = False
