"""A virtual serial line on a pseudo-terminal, for clients in other processes."""

import fcntl
import os
import pty
import select
import struct
import tty

from sim_backends.virtual.host_port import Device

_TCGETS2 = 0x802C542A
_TERMIOS2 = struct.Struct("4IB19B2I")
_READ_SIZE = 4096


class PtyLine:
    """One line: what a client writes goes to the device, what the device sends to the client.

    As on a real port, what is sent while no client holds the port, or faster than it reads, is
    lost; and the client's baud counts. Without a client the terminal is hung up, which `fileno`
    reports for as long as it lasts: wait for edges.
    """

    def __init__(self, device: Device) -> None:
        self._device = device
        self._has_client = self._closed = False
        self._master, slave = pty.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        """Where clients open it."""
        os.close(slave)
        os.set_blocking(self._master, False)
        self._poll = select.poll()
        self._poll.register(self._master, 0)

    def fileno(self) -> int:
        """For epoll."""
        return self._master

    def serve(self, events: int) -> None:
        """React to what epoll reports: the client wrote, or hung up."""
        if events & select.EPOLLHUP:
            self._has_client = False
        if events & select.EPOLLIN:
            self._receive()

    def _look_for_client(self) -> bool:
        """Whether somebody holds the port open: coming is not reported, only going is."""
        self._has_client = not any(event & select.POLLHUP for _, event in self._poll.poll(0))
        return self._has_client

    def send(self, data: bytes) -> None:
        """Hand bytes to the client, if there is one."""
        if self._closed or not (self._has_client or self._look_for_client()):
            return
        try:
            os.write(self._master, data)
        except BlockingIOError:
            return  # The client does not read: its driver's buffer is full, bytes are lost.

    def _receive(self) -> None:
        """Hand all that the client wrote to the device."""
        more = True
        while more:
            try:
                data = os.read(self._master, _READ_SIZE)
            except OSError:
                return  # Nothing more, or the client went away.
            if data:
                self._device.host_wrote(data, self._baud())
            more = len(data) == _READ_SIZE

    def _baud(self) -> int:
        """Speed that the client set [bit/s], any number, as the real driver would use it."""
        raw = fcntl.ioctl(self._master, _TCGETS2, bytes(_TERMIOS2.size))
        return int(_TERMIOS2.unpack(raw)[-1])

    def hang_up(self) -> None:
        """The adapter is pulled out: clients get an error, and nothing comes back."""
        os.close(self._master)
        self._closed = True

    def close(self) -> None:
        """Hang up; safe after `hang_up`."""
        if not self._closed:
            self.hang_up()
