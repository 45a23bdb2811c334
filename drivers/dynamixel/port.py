"""A serial port: opened exclusively, read and written without blocking, waited for by the Clock."""

import sys

import serial
from serial.tools import list_ports

from hil.errors import BackendError, PortError


class Port:
    """One open port. What can go wrong on it later is a BackendError that names it."""

    def __init__(self, name: str, url: str, baud: int) -> None:
        """Open `url`: a device path, a pts path or a pyserial URL. Raises PortError."""
        self.name = name
        self.url = url
        self.baud = baud
        self.stream = _open(name, url, baud)
        """The pyserial object, for `Clock.wait_readable`."""
        self.low_latency = _set_low_latency(self.stream)
        """Whether the driver was told to hand bytes over at once."""
        self.sent_bytes = 0
        self.received_bytes = 0

    def write(self, data: bytes) -> None:
        """Hand all of `data` to the driver. Raises BackendError."""
        try:
            written = self.stream.write(data)
        except (OSError, serial.SerialException) as error:
            raise self._lost(error) from error
        if written != len(data):
            raise BackendError(
                f"port {self.name} ({self.url}) took {written} of {len(data)} bytes: it is blocked"
            )
        self.sent_bytes += len(data)

    def read_available(self) -> bytes:
        """Everything received so far, without waiting. Raises BackendError."""
        try:
            waiting = self.stream.in_waiting
            if not waiting:
                return b""
            data = self.stream.read(waiting)
        except (OSError, serial.SerialException) as error:
            raise self._lost(error) from error
        self.received_bytes += len(data)
        return data

    def discard_input(self) -> int:
        """Throw away what was received; the number of bytes."""
        return len(self.read_available())

    def set_baud(self, baud: int) -> None:
        """Change the speed [bit/s]."""
        self.stream.baudrate = baud
        self.baud = baud

    def close(self) -> None:
        """Close the port; safe to call twice and on a port that is gone."""
        self.stream.close()

    def _lost(self, error: Exception) -> BackendError:
        return BackendError(f"port {self.name} ({self.url}) is lost: {error}")


def _open(name: str, url: str, baud: int) -> serial.Serial:
    try:
        stream = serial.serial_for_url(
            url, baudrate=baud, timeout=0, write_timeout=0, do_not_open=True
        )
        if sys.platform != "win32":
            stream.exclusive = True
        stream.open()
    except (OSError, ValueError, serial.SerialException) as error:
        found = ", ".join(sorted(port.device for port in list_ports.comports())) or "none"
        raise PortError(
            f"{name}: cannot open port {url!r}: {error}; serial ports found: {found}"
        ) from error
    return stream


def _set_low_latency(stream: serial.Serial) -> bool:
    """Ask the USB driver for low latency; ports without that (ptys, virtual ones) say no."""
    setter = getattr(stream, "set_low_latency_mode", None)
    if setter is None:
        return False
    try:
        setter(True)
    except (OSError, ValueError, NotImplementedError):
        return False
    return True
