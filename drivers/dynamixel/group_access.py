"""One register of many servos at once, blocking: for opening, arming and stopping a bus."""

from collections.abc import Iterable, Mapping, Sequence

from drivers.dynamixel.budget import BusTiming, reply_size
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.port import Port
from drivers.dynamixel.protocol import (
    ERROR_MASK,
    PacketReader,
    encode_sync_read,
    encode_sync_write,
)
from hil.interface import Clock

ATTEMPTS = 4
"""How often servos that did not answer are asked."""
MARGIN_NS = 20_000_000
"""Waiting beyond wire and adapter: factory Return Delay Time (0.5 ms a servo) and the host's
wake-up (assumed)."""
QUIET_NS = 5_000_000
"""A line that says nothing for so long has no late answer under way."""


class GroupAccess:
    """Sync reads and writes of single registers on one bus."""

    def __init__(self, port: Port, timing: BusTiming, clock: Clock) -> None:
        self._port = port
        self._timing = timing
        self._clock = clock

    def write(self, register: Register, values: Mapping[int, int]) -> None:
        """Write a register of several servos, by id; nobody acknowledges."""
        items = [(servo_id, register.spec.encode(value)) for servo_id, value in values.items()]
        self._port.write(encode_sync_write(register.address, register.size, items))

    def write_all(self, register: Register, ids: Iterable[int], value: int) -> None:
        """Write one value to a register of several servos; nobody acknowledges."""
        self.write(register, dict.fromkeys(ids, value))

    def read(self, register: Register, ids: Sequence[int]) -> dict[int, int]:
        """Values by id, of those servos that answer in the end."""
        values: dict[int, int] = {}
        for attempt in range(ATTEMPTS):
            missing = [servo_id for servo_id in ids if servo_id not in values]
            if not missing:
                break
            # A silent servo silences those behind it: ask in another order each time.
            shift = attempt % len(missing)
            values.update(self._read_once(register, missing[shift:] + missing[:shift]))
            if len(values) < len(ids):
                self._await_quiet()
        return values

    def _await_quiet(self) -> None:
        """Drop late answers: the next request's could be as long and be taken for them."""
        deadline_ns = self._clock.now_ns() + MARGIN_NS
        while self._clock.now_ns() < deadline_ns:
            self._port.discard_input()
            until_ns = self._clock.now_ns() + QUIET_NS
            self._clock.wait_readable([self._port.stream], until_ns)
            if self._clock.now_ns() >= until_ns:
                return

    def _read_once(self, register: Register, ids: Sequence[int]) -> dict[int, int]:
        request = encode_sync_read(ids, register.address, register.size)
        size = reply_size([register.size] * len(ids), fast=False)
        self._port.discard_input()
        self._port.write(request)
        duration_ns = self._timing.read_time_ns(len(request), size, len(ids), fast=False)
        deadline_ns = self._clock.now_ns() + duration_ns + MARGIN_NS
        reader = PacketReader()
        values: dict[int, int] = {}
        while len(values) < len(ids):
            for packet in reader.feed(self._port.read_available()):
                usable = packet.is_status and not packet.error & ERROR_MASK
                if usable and packet.id in ids and len(packet.data) == register.size:
                    values[packet.id] = register.spec.decode(packet.data)
            if self._clock.now_ns() >= deadline_ns:
                break
            if len(values) < len(ids):
                self._clock.wait_readable([self._port.stream], deadline_ns)
        return values
