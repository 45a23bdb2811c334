"""The host's end of a virtual serial line: what was received, and who is on the other side."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

from sim_backends.virtual.clock import VirtualClock


class Device(Protocol):
    """What hangs on a serial line."""

    def host_wrote(self, data: bytes, baud: int) -> None:
        """The host hands bytes to its driver now."""
        ...


class HostPort:
    """One line: bytes from the host go to the device, bytes for the host into `received`.

    `on_bytes` takes what is delivered instead, where the line is a pseudo-terminal.
    """

    def __init__(self, name: str, clock: VirtualClock) -> None:
        self.name = name
        self.received = bytearray()
        """Delivered and not read yet."""
        self.is_open = False
        """A serial object of this process holds it."""
        self.plugged = True
        """The adapter is there."""
        self.plugged_times = 0
        """How often it was plugged in again; who opened it before has lost it."""
        self.on_unplug: Callable[[], None] = lambda: None
        self.last_read_ns = 0
        """When the host last took bytes."""
        self.on_bytes: Callable[[bytes], None] = self._keep
        self._clock = clock

    def unplug(self) -> None:
        """The adapter is pulled out: whoever holds the port has lost it."""
        self.plugged = self.is_open = False
        self.received.clear()
        self._clock.deliveries += 1
        self.on_unplug()

    def plug_in(self) -> None:
        """The adapter is back, and can be opened again."""
        self.plugged = True
        self.plugged_times += 1

    def deliver_at(self, time_ns: int, data: bytes) -> None:
        """Have bytes arrive in the host at a time."""
        self._clock.schedule(time_ns, partial(self.on_bytes, data))

    def _keep(self, data: bytes) -> None:
        self.received += data
        self._clock.deliveries += 1

    def take(self, size: int) -> bytes:
        """Read up to `size` bytes."""
        data = bytes(self.received[:size])
        del self.received[:size]
        self.last_read_ns = self._clock.now_ns()
        return data
