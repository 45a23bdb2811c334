"""Plain HTTP GET on a Unix socket, for the gate."""

import asyncio

from websockets.datastructures import Headers
from websockets.http11 import Response

KEPT = (
    "Content-Type",
    "Cache-Control",
    "Cross-Origin-Opener-Policy",
    "Cross-Origin-Embedder-Policy",
)
"""Headers that are passed on; the one that lets any site read the answer is not."""
TIMEOUT_S = 20.0


async def fetch(address: str, path: str) -> Response:
    """The answer of the server on a Unix socket to GET `path`; 502 if there is none."""
    try:
        async with asyncio.timeout(TIMEOUT_S):
            return _parsed(await _exchange(address, path))
    except (OSError, TimeoutError, ValueError):
        return Response(502, "Bad Gateway", Headers({"Content-Length": "0"}), b"")


async def _exchange(address: str, path: str) -> bytes:
    reader, writer = await asyncio.open_unix_connection(address)
    try:
        request = f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        writer.write(request.encode("ascii"))
        await writer.drain()
        return await reader.read(-1)
    finally:
        writer.close()


def _parsed(answer: bytes) -> Response:
    """Raises ValueError on what is no HTTP answer."""
    head, body = answer.split(b"\r\n\r\n", 1)
    first, *lines = head.decode("latin-1").split("\r\n")
    _, status, reason = first.split(" ", 2)
    given = Headers()
    for line in lines:
        name, value = line.split(": ", 1)
        given[name] = value
    kept = {name: given.get_all(name) for name in KEPT}
    headers = Headers({name: values[0] for name, values in kept.items() if values})
    headers["Content-Length"] = str(len(body))
    headers["Cross-Origin-Resource-Policy"] = "same-origin"
    return Response(int(status), reason, headers, body)
