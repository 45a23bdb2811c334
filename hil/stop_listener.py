"""The operator's other ways to stop a run: keys of its terminal, and a socket in its folder."""

import os
import select
import signal
import socket
import sys
import termios
import threading
import tty
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Protocol

SOCKET = "stop"
"""Name of the socket in the run folder."""
HINT = "space: torque off now; q or Ctrl-C: sit down\n"
KEYS = {b" ": True, b"q": False}
"""Key to whether it means now."""
WORDS = {b"off": True, b"sit": False}
ANSWER_TIMEOUT_S = 0.5
CLIENT_TIMEOUT_S = 0.05
"""A client that says nothing must not keep a key from being heard."""

Source = Callable[[], bool]
"""Serves what is readable; False when there will be nothing more."""


class Post(Protocol):
    """Takes a request to stop, from any thread."""

    def __call__(self, name: str, *, now: bool) -> None:
        """`name` of who asked; `now`: torque off at once."""
        ...


class StopListener:
    """A thread that sleeps until a key is pressed or a client connects: the tick pays nothing.

    Keys count while standard input is a terminal that this process has in the foreground. The
    socket belongs to its user (0600) and knows two words: `off` and `sit`; it answers `ok`.
    """

    def __init__(self, folder: Path) -> None:
        """`folder` exists; the socket is there while `listening` lasts."""
        self._folder = folder

    @contextmanager
    def listening(self, post: Post) -> Iterator[None]:
        """Hand what the operator asks for to `post` for the block; in the main thread only."""
        with ExitStack() as stack:
            ending, end = socket.socketpair()
            stack.enter_context(ending)
            sources: dict[int, Source] = {}
            if _has_terminal():
                stack.enter_context(_single_keys())
                sources[sys.stdin.fileno()] = lambda: _take_keys(post)
                sys.stderr.write(HINT)
            listener = stack.enter_context(_bound(self._folder))
            sources[listener.fileno()] = lambda: _take_client(listener, post)
            thread = threading.Thread(target=_listen, args=(ending, sources), daemon=True)
            thread.start()
            stack.callback(thread.join)
            stack.enter_context(end)  # closed first: that ends the thread
            yield


def ask_to_stop(folder: Path, word: str) -> None:
    """Send a word to the run in a folder. Raises OSError if none listens there."""
    with socket.socket(socket.AF_UNIX) as client, _opened(folder) as place:
        client.settimeout(ANSWER_TIMEOUT_S)
        client.connect(f"{place}/{SOCKET}")
        client.sendall(word.encode() + b"\n")
        client.recv(16)


def _listen(ending: socket.socket, sources: dict[int, Source]) -> None:
    while True:
        ready, _, _ = select.select([ending.fileno(), *sources], [], [])
        if ending.fileno() in ready:
            return
        for number in ready:
            if not sources[number]():
                del sources[number]


def _take_keys(post: Post) -> bool:
    try:
        keys = os.read(sys.stdin.fileno(), 16)
    except OSError:
        keys = b""  # The terminal is gone, which SIGHUP tells too.
    for key in (bytes([number]) for number in keys):
        if key in KEYS:
            post("key space" if key == b" " else f"key {key.decode()}", now=KEYS[key])
    return bool(keys)


def _take_client(listener: socket.socket, post: Post) -> bool:
    with suppress(OSError):  # a client that is gone again wants nothing
        client, _ = listener.accept()
        with client:
            client.settimeout(CLIENT_TIMEOUT_S)
            word = client.recv(16).strip()
            if word in WORDS:
                post("socket", now=WORDS[word])
            client.sendall(b"ok\n" if word in WORDS else b"say off or sit\n")
    return True


def _has_terminal() -> bool:
    """A terminal in the foreground: another job's keys are not ours."""
    try:
        return sys.stdin.isatty() and os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (OSError, ValueError):
        return False


@contextmanager
def _single_keys() -> Iterator[None]:
    """Keys arrive one by one and are not shown, until the block ends."""
    number = sys.stdin.fileno()
    before = termios.tcgetattr(number)
    # A job that was put into the background meanwhile must not be suspended for looking.
    handlers = {s: signal.signal(s, signal.SIG_IGN) for s in (signal.SIGTTIN, signal.SIGTTOU)}
    try:
        tty.setcbreak(number, termios.TCSANOW)
        yield
    finally:
        with suppress(termios.error):  # the terminal may be gone
            termios.tcsetattr(number, termios.TCSANOW, before)
        for number_of, handler in handlers.items():
            signal.signal(number_of, handler)


@contextmanager
def _bound(folder: Path) -> Iterator[socket.socket]:
    with socket.socket(socket.AF_UNIX) as listener, _opened(folder) as place:
        os.fchmod(listener.fileno(), 0o600)  # before it has a name, so that there is no moment
        listener.bind(f"{place}/{SOCKET}")
        listener.listen()
        try:
            yield listener
        finally:
            (folder / SOCKET).unlink(missing_ok=True)


@contextmanager
def _opened(folder: Path) -> Iterator[str]:
    """A short name of a folder: a socket's address holds 107 bytes."""
    number = os.open(folder, os.O_PATH | os.O_DIRECTORY)
    try:
        yield f"/proc/self/fd/{number}"
    finally:
        os.close(number)
