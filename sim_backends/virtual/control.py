"""The control socket beside the serial lines: JSON lines that a real robot does not have."""

import json
import select
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hil.errors import StrideError

Request = dict[str, Any]
Handler = Callable[[Request], dict[str, Any]]


class ControlServer:
    """Answers requests `{"do": name, …}` with `{"ok": true, …}` or `{"ok": false, "error": …}`."""

    def __init__(self, path: Path, handlers: dict[str, Handler]) -> None:
        self._handlers = handlers
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen()
        self._clients: dict[socket.socket, bytes] = {}
        self._poll = select.epoll()
        self._poll.register(self._listener, select.EPOLLIN)

    def fileno(self) -> int:
        """For select: readable when there is something to serve."""
        return self._poll.fileno()

    def serve(self, _: int) -> None:
        """Accept clients, and answer what they sent."""
        ready = {number for number, _ in self._poll.poll(0)}
        for client in [client for client in self._clients if client.fileno() in ready]:
            self._serve_client(client)
        if self._listener.fileno() in ready:
            client, _ = self._listener.accept()
            client.settimeout(1.0)
            self._clients[client] = b""
            self._poll.register(client, select.EPOLLIN)

    def _serve_client(self, ready: socket.socket) -> None:
        try:
            data = ready.recv(65536)
            *lines, rest = (self._clients[ready] + data).split(b"\n")
            self._clients[ready] = rest
            for line in lines:
                ready.sendall(json.dumps(self._answer(line)).encode() + b"\n")
        except OSError:
            data = b""
        if not data:
            self._poll.unregister(ready)
            del self._clients[ready]
            ready.close()

    def _answer(self, line: bytes) -> dict[str, Any]:
        try:
            request = json.loads(line)
            handler = self._handlers[request["do"]]
            return {"ok": True, **handler(request)}
        except (KeyError, TypeError, ValueError, StrideError) as error:
            valid = ", ".join(self._handlers)
            return {"ok": False, "error": f"{type(error).__name__}: {error}; do: {valid}"}

    def close(self) -> None:
        """Close all sockets."""
        self._poll.close()
        for client in (self._listener, *self._clients):
            client.close()


def three_numbers(values: object) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A finite vector out of a request. Raises ValueError."""
    vector = np.asarray(values, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ValueError(f"needs three finite numbers, got {values!r}")
    return vector
