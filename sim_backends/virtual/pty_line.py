"""A virtual serial line on a pseudo-terminal, for clients in other processes."""

import fcntl
import os
import pty
import select
import struct
import tty

from sim_backends.virtual.host_port import Device, HostPort

_TCGETS2 = 0x802C542A
_TERMIOS2 = struct.Struct("4IB19B2I")
_READ_SIZE = 4096


class PtyLine:
    """One line: what a client writes goes to the device, what the device sends to the client.

    As on a real port, what is sent while no client holds the port, or faster than it reads, is
    lost; and the client's baud counts. Without a client the terminal is hung up, and `fileno`
    must not be waited for.
    """

    def __init__(self, port: HostPort, device: Device) -> None:
        self._device = device
        self._master, slave = pty.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        """Where clients open it."""
        os.close(slave)
        os.set_blocking(self._master, False)
        self._poll = select.poll()
        self._poll.register(self._master, 0)
        port.on_bytes = self._send

    def fileno(self) -> int:
        """For select."""
        return self._master

    def has_client(self) -> bool:
        """Whether somebody holds the port open."""
        return not any(event & select.POLLHUP for _, event in self._poll.poll(0))

    def _send(self, data: bytes) -> None:
        if not self.has_client():
            return
        try:
            os.write(self._master, data)
        except BlockingIOError:
            return  # The client does not read: its driver's buffer is full, bytes are lost.

    def receive(self) -> None:
        """Hand what the client wrote to the device."""
        try:
            data = os.read(self._master, _READ_SIZE)
        except OSError:
            return  # The client went away between select and read.
        if data:
            self._device.host_wrote(data, self._baud())

    def _baud(self) -> int:
        """Speed that the client set [bit/s], any number, as the real driver would use it."""
        raw = fcntl.ioctl(self._master, _TCGETS2, bytes(_TERMIOS2.size))
        return int(_TERMIOS2.unpack(raw)[-1])

    def close(self) -> None:
        """Hang up."""
        os.close(self._master)
