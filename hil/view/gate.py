"""The gate before Studio's web server: loopback only, and nobody steers without the token."""

import asyncio
import hmac
import secrets
import socket
import threading
from collections.abc import AsyncIterator
from contextlib import suppress
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from urllib.parse import SplitResult, parse_qs, urlsplit

from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.http11 import Request, Response

from hil.timing import stopwatch_ns
from hil.view.inner_http import fetch

HOST = "127.0.0.1"
PORTS = range(8080, 8100)
LOCAL_NAMES = ("127.0.0.1", "localhost", "::1")
"""What a browser may call us: any other name is a page that was made to point here."""
PANELS, SCENE = "/ui", "/state"
TAKEN = 4001
"""Studio's close code for "somebody else controls": a page that may not steer then watches."""
WATCHING = ("state_ack", "heartbeat", "leave_queue")
"""All that a page that only watches may say."""
LARGEST = 1 << 26


class Gate:
    """Serves browsers on 127.0.0.1 and speaks to Studio's server on its Unix socket.

    | | without the token | with it |
    |---|---|---|
    | page, model, scene | yes | yes |
    | panels and what they steer | no | yes |
    | camera, request or steal control | no | yes |
    | dropped files | no | no |

    A page from elsewhere (another Host or Origin) gets nothing.
    """

    def __init__(self, inner: Path) -> None:
        """`inner`: Unix socket of Studio's server. Binds at once. Raises OSError."""
        self._inner = str(inner)
        self._socket = _bound()
        self.port: int = self._socket.getsockname()[1]
        self.token = secrets.token_urlsafe(16)
        self.heard_s = -1e9
        """Wall time [s] at which a page that may steer was last heard of."""
        self.heard = 0
        """How often: it speaks once for every picture that it draws."""
        self._cookie = f"stride_{self.port}"
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, daemon=True)

    @property
    def watch_url(self) -> str:
        """For looking on."""
        return f"http://{HOST}:{self.port}/"

    @property
    def steer_url(self) -> str:
        """For steering, too."""
        return f"{self.watch_url}?token={self.token}"

    def start(self) -> None:
        """Serve from a thread, until the process ends."""
        self._thread.start()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._serve())

    async def _serve(self) -> None:
        async with serve(
            self._meet,
            sock=self._socket,
            process_request=self._answer,
            compression=None,
            ping_interval=None,
            max_size=LARGEST,
        ) as server:
            await server.serve_forever()

    async def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """The answer to a request for a page; None lets a WebSocket go on to `_meet`."""
        del connection
        if not _from_here(request):
            return _refusal(403, "Forbidden", "this view answers to 127.0.0.1 and localhost only")
        parts = _split(request.path)
        if parts.fragment:
            return _refusal(404, "Not Found", "a fragment is the browser's own concern")
        if parts.path in (PANELS, SCENE):
            return None
        token = parse_qs(parts.query).get("token")
        if parts.path == "/" and token is not None:
            return self._welcome(token[0])
        if parts.path == "/drop":
            return _refusal(403, "Forbidden", "nothing may be dropped onto a run")
        return await fetch(self._inner, request.path)

    def _welcome(self, token: str) -> Response:
        """Keep a right token as a cookie, out of the address bar."""
        if not self._is_token(token):
            return _refusal(403, "Forbidden", "not the token that this run's terminal shows")
        headers = Headers()
        headers["Location"] = "/"
        headers["Set-Cookie"] = f"{self._cookie}={token}; Path=/; HttpOnly; SameSite=Strict"
        headers["Content-Length"] = "0"
        return Response(303, "See Other", headers, b"")

    async def _meet(self, outer: ServerConnection) -> None:
        request = outer.request
        if request is None:
            return
        steers, panels = self._may_steer(request), _split(request.path).path == PANELS
        if panels and not steers:
            await outer.close(TAKEN, "watching: the token is in the run's terminal")
            return
        with suppress(ConnectionClosed, InvalidHandshake, OSError):
            async with unix_connect(
                self._inner,
                f"ws://localhost{request.path}",
                compression=None,
                ping_interval=None,
                max_size=LARGEST,
            ) as inner:
                outward = asyncio.create_task(_pass_on(inner, outer))
                await self._pass_in(outer, inner, steers=steers, panels=panels)
                outward.cancel()

    async def _pass_in(
        self, outer: ServerConnection, inner: ClientConnection, *, steers: bool, panels: bool
    ) -> None:
        """What a browser says, as far as it may say it, until either end closes."""
        closed = asyncio.create_task(_close_with(inner, outer))
        async for message in outer:
            if panels:
                self.heard_s = stopwatch_ns() * 1e-9
                self.heard += 1
            if steers or (isinstance(message, str) and message in WATCHING):
                await inner.send(message)
        closed.cancel()

    def _may_steer(self, request: Request) -> bool:
        jar = SimpleCookie()
        with suppress(CookieError):
            for header in request.headers.get_all("Cookie"):
                jar.load(header)
        return self._cookie in jar and self._is_token(jar[self._cookie].value)

    def _is_token(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(), self.token.encode())


async def _messages(source: ClientConnection) -> AsyncIterator[str | bytes]:
    with suppress(ConnectionClosed):
        async for message in source:
            yield message


async def _pass_on(inner: ClientConnection, outer: ServerConnection) -> None:
    """What the server says goes to the browser as it is."""
    with suppress(ConnectionClosed):
        async for message in _messages(inner):
            await outer.send(message)


async def _close_with(inner: ClientConnection, outer: ServerConnection) -> None:
    """Close the browser's end as the server closed its own: the code tells the page what to do."""
    await inner.wait_closed()
    await outer.close(inner.close_code or 1001, inner.close_reason or "")


def _from_here(request: Request) -> bool:
    """Whether Host, and Origin where there is one, are names of this machine's loopback."""
    hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
    if len(hosts) != 1 or _split(f"//{hosts[0]}").hostname not in LOCAL_NAMES:
        return False
    return all(_split(origin).netloc == hosts[0] for origin in origins)


def _split(url: str) -> SplitResult:
    """The parts of an address; empty ones where it is none."""
    try:
        return urlsplit(url)
    except ValueError:
        return urlsplit("")


def _refusal(status: int, reason: str, text: str) -> Response:
    headers = Headers()
    headers["Content-Type"] = "text/plain; charset=utf-8"
    body = text.encode() + b"\n"
    headers["Content-Length"] = str(len(body))
    return Response(status, reason, headers, body)


def _bound() -> socket.socket:
    """The first free port of `PORTS`, or any. Raises OSError."""
    for port in (*PORTS, 0):
        listener = socket.socket(socket.AF_INET)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((HOST, port))
            listener.listen()
            return listener
        except OSError:
            listener.close()
    raise OSError("no port of 127.0.0.1 is free")
