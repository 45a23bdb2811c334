"""pyserial's handler of `virtual://robot/port`: lines of a virtual robot in this process.

pyserial finds this module by its name in the packages of `serial.protocol_handler_packages`.
"""

from typing import Any

import serial

from sim_backends.virtual.host_port import Device, HostPort

SCHEME = "virtual://"
_lines: dict[str, tuple[HostPort, Device]] = {}


def register(url: str, port: HostPort, device: Device) -> None:
    """Make a line available under a URL."""
    package = __package__ or "sim_backends.virtual"
    if package not in serial.protocol_handler_packages:
        serial.protocol_handler_packages.append(package)
    _lines[url] = (port, device)


def unregister(url: str) -> None:
    """Take a line away; a serial object that holds it keeps it."""
    _lines.pop(url, None)


class Serial(serial.SerialBase):
    """pyserial's interface on a virtual line. It never blocks: time passes in the virtual clock."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._line: HostPort | None = None
        self._device: Device | None = None
        self._opened = 0
        super().__init__(*args, **kwargs)

    def open(self) -> None:
        """Take the line. Raises SerialException if it is unknown or taken."""
        if self._line is not None:
            raise serial.SerialException("Port is already open.")
        if self.port not in _lines:
            known = ", ".join(_lines) or "none"
            raise serial.SerialException(f"no virtual port {self.port!r}; there are: {known}")
        line, device = _lines[self.port]
        if line.is_open:
            raise serial.SerialException(f"virtual port {self.port!r} is in use")
        if not line.plugged:
            raise serial.SerialException(f"virtual port {self.port!r}: no such device")
        line.is_open = True
        line.received.clear()
        self._opened = line.plugged_times
        self._line, self._device, self.is_open = line, device, True

    def close(self) -> None:
        """Give the line back; safe to call twice."""
        line = self._line
        if line is not None and line.plugged and line.plugged_times == self._opened:
            line.is_open = False
        self._line, self._device, self.is_open = None, None, False

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        line = self._line
        if line is None or not line.plugged or line.plugged_times != self._opened:
            line = self._held()
        return len(line.received)

    def read(self, size: int = 1) -> bytes:
        """Up to `size` bytes that have arrived."""
        return self._held().take(size)

    def write(self, data: Any, /) -> int:
        """Hand bytes to the device at the present virtual time."""
        self._held()
        sent = bytes(data)
        if self._device is not None:
            self._device.host_wrote(sent, self.baudrate)
        return len(sent)

    def reset_input_buffer(self) -> None:
        """Discard what has arrived."""
        self._held().received.clear()

    def reset_output_buffer(self) -> None:
        """Nothing waits here: bytes go out when they are written."""

    def flush(self) -> None:
        """Nothing waits here."""

    def _held(self) -> HostPort:
        line = self._line
        if line is None:
            raise serial.PortNotOpenError()
        if not line.plugged or line.plugged_times != self._opened:
            raise serial.SerialException(f"virtual port {self.port!r}: device disconnected")
        return line

    def _reconfigure_port(self) -> None:
        """The device looks at the speed of every write; nothing to set."""
