"""What a browser, a stranger and a page from elsewhere get from the view's server."""

import urllib.error
import urllib.request
from pathlib import Path
from socket import create_connection

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from hil.robot_files import load_robot
from hil.view.gate import Gate
from hil.view.inner_server import WebPicture
from hil.view.stage import stage_model

UPGRADE = (
    "Upgrade: websocket",
    "Connection: Upgrade",
    "Sec-WebSocket-Version: 13",
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
)
"""A handshake with the nonce of RFC 6455, section 1.3."""


@pytest.fixture(scope="module")
def gate():
    picture = WebPicture("test", stage_model(load_robot("minibiped")))
    gate = Gate(picture.address)
    gate.start()
    picture.publish()
    yield gate
    picture.close()


class Stay(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, *_):
        return None


def get(gate, path, **headers):
    request = urllib.request.Request(f"http://127.0.0.1:{gate.port}{path}", headers=headers)
    try:
        with urllib.request.build_opener(Stay).open(request, timeout=10) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.headers, error.read()


def cookie(gate, token=None):
    return {"Cookie": f"stride_{gate.port}={token or gate.token}"}


def socket(gate, path, headers=None, **more):
    url = f"ws://127.0.0.1:{gate.port}{path}"
    return connect(url, additional_headers=headers, open_timeout=10, **more)


def closing_code(connection):
    try:
        while True:
            connection.recv(timeout=10)
    except ConnectionClosed as closed:
        return closed.rcvd.code


def roles(connection, count):
    """The next roster lines' roles."""
    found = []
    while len(found) < count:
        message = connection.recv(timeout=10)
        if isinstance(message, str) and message.startswith("viewers="):
            found.append(message.split(";")[1])
    return found


def test_it_is_bound_to_loopback(gate):
    assert gate._socket.getsockname()[0] == "127.0.0.1"


def test_a_page_that_only_watches_gets_the_page_and_the_model(gate):
    status, headers, body = get(gate, "/")
    assert status == 200 and b"<canvas" in body
    assert headers["Cross-Origin-Embedder-Policy"] == "require-corp"
    assert "Access-Control-Allow-Origin" not in headers
    assert get(gate, "/model")[0] == 200
    assert get(gate, "/no-such-file")[0] == 404


def test_the_token_becomes_a_cookie_and_leaves_the_address(gate):
    status, headers, _ = get(gate, f"/?token={gate.token}")
    assert status == 303 and headers["Location"] == "/"
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]


def test_a_wrong_token_is_told_where_the_right_one_is(gate):
    status, headers, body = get(gate, "/?token=guess")
    assert status == 403 and b"terminal" in body and "Set-Cookie" not in headers


@pytest.mark.parametrize("headers", [None, {"Cookie": "stride_8080=guess"}])
def test_nobody_reaches_the_panels_without_the_token(gate, headers):
    with socket(gate, "/ui?sid=a", headers) as panels:
        assert closing_code(panels) == 4001


def test_the_panels_open_with_the_token_and_a_hand_is_heard(gate):
    before = gate.heard_s
    with socket(gate, "/ui?sid=b", cookie(gate)) as panels:
        panels.send(bytes(120))
        with pytest.raises((TimeoutError, ConnectionClosed)):
            panels.recv(timeout=1)
    assert gate.heard_s > before


def test_a_spectator_sees_the_scene_and_cannot_steal_or_ask_for_control(gate):
    with socket(gate, "/state?sid=s") as scene:
        messages = [scene.recv(timeout=10) for _ in range(2)]
        assert any(isinstance(message, bytes) and len(message) > 1000 for message in messages)
        for word in ("force_control", "request_control", "max_spectators=0", "theme=light"):
            scene.send(word)
        scene.send(bytes(64))
        with socket(gate, "/state?sid=t"):  # makes the server tell the roster
            assert roles(scene, 1) == ["role=spectator"]
        with pytest.raises(TimeoutError):
            while scene.recv(timeout=1) != "grant":
                pass


def test_somebody_with_the_token_may_take_over(gate):
    with socket(gate, "/state?sid=c", cookie(gate)) as scene:
        scene.send("force_control")
        while scene.recv(timeout=10) != "grant":
            pass


@pytest.mark.parametrize("path", ["/", "/model", "/state"])
def test_a_name_that_was_made_to_point_here_gets_nothing(gate, path):
    assert get(gate, path, Host="evil.example")[0] == 403


@pytest.mark.parametrize("path", ["/state?sid=x", "/ui?sid=x"])
def test_a_page_from_elsewhere_gets_no_socket_whatever_cookie_it_rides_on(gate, path):
    with pytest.raises(InvalidStatus) as refused:
        socket(gate, path, cookie(gate), origin="http://evil.example")
    assert refused.value.response.status_code == 403


@pytest.mark.parametrize(
    "lines",
    [
        ["GET //[x HTTP/1.1", "Host: 127.0.0.1"],
        ["GET / HTTP/1.1", "Host: 127.0.0.1", "Host: 127.0.0.1"],
        ["GET / HTTP/1.1", "Host: 127.0.0.1", "Origin: http://[x"],
        ["GET /state#x HTTP/1.1", "Host: 127.0.0.1", *UPGRADE],
    ],
)
def test_a_request_that_makes_no_sense_is_refused_without_a_traceback(gate, lines, caplog):
    """The view's log is the run's terminal, where the software stop is asked for."""
    with create_connection(("127.0.0.1", gate.port), 10) as wire:
        wire.sendall("\r\n".join([*lines, "", ""]).encode())
        status = int(wire.recv(4096).split()[1])
    assert status in (403, 404)
    assert [record for record in caplog.records if record.exc_info] == []


def test_nothing_can_be_dropped(gate):
    with pytest.raises(InvalidStatus) as refused:
        socket(gate, "/drop?sid=x", cookie(gate))
    assert refused.value.response.status_code == 403


def test_the_server_behind_it_has_no_address_that_others_reach(gate):
    assert oct(Path(gate._inner).parent.stat().st_mode)[-3:] == "700"
