"""A serial port: opened exclusively, read and written without blocking, waited for by the Clock."""

import sys
from contextlib import suppress
from pathlib import Path

import serial
from serial.tools import list_ports

from hil.errors import BackendError, PortError

USB_SERIAL = Path("/sys/bus/usb-serial/devices")
"""Where Linux shows the latency timers of USB serial adapters."""
BY_ID = Path("/dev/serial/by-id")
"""Names of serial ports that tell the adapter, not the order of plugging in."""


class Port:
    """One open port. What can go wrong on it later is a BackendError that names it."""

    def __init__(self, name: str, url: str, baud: int) -> None:
        """Open `url`: a device path, a pts path or a pyserial URL. Raises PortError."""
        self.name = name
        self.url = url
        self.baud = baud
        self.stream = _open(name, url, baud)
        """The pyserial object, for `Clock.wait_readable`."""
        _set_low_latency(self.stream)
        self.latency_timer_ms = read_latency_timer_ms(url)
        """Of its USB adapter, after it was told to be fast; None where the system does not say."""
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


def _stable_name(device: str) -> str:
    """The name by which an adapter is found again after it was plugged in anew, if there is one."""
    links = BY_ID.iterdir() if BY_ID.is_dir() else ()
    target = Path(device).resolve()
    return next((str(link) for link in links if link.resolve() == target), device)


def _open(name: str, url: str, baud: int) -> serial.Serial:
    try:
        stream = serial.serial_for_url(
            url, baudrate=baud, timeout=0, write_timeout=0, do_not_open=True
        )
        if sys.platform != "win32":
            stream.exclusive = True
        stream.open()
    except (OSError, ValueError, serial.SerialException) as error:
        found = ", ".join(sorted(_stable_name(port.device) for port in list_ports.comports()))
        raise PortError(
            f"{name}: cannot open port {url!r}: {error}; serial ports found: {found or 'none'}"
        ) from error
    return stream


def _set_low_latency(stream: serial.Serial) -> None:
    """Ask the USB driver for low latency; ptys and virtual ports have no such thing."""
    setter = getattr(stream, "set_low_latency_mode", None)
    if setter is not None:
        with suppress(OSError, ValueError, NotImplementedError):
            setter(True)


def read_latency_timer_ms(path: str, root: Path = USB_SERIAL) -> int | None:
    """Latency timer of the USB adapter behind a device path, as the kernel's driver has it [ms]."""
    try:
        return int((root / Path(path).resolve().name / "latency_timer").read_text())
    except (OSError, ValueError):
        return None


def latency_warning(port: Port, wanted_ms: int) -> str | None:
    """What to do about an adapter that holds answers back for longer than it should."""
    found_ms = port.latency_timer_ms
    if found_ms is None or found_ms <= wanted_ms:
        return None
    device = Path(port.url).resolve().name
    return (
        f"port {port.name} ({port.url}) holds answers back for {found_ms} ms, {wanted_ms} ms are "
        f"planned: echo {wanted_ms} | sudo tee {USB_SERIAL / device / 'latency_timer'}"
    )
