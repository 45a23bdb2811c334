"""The operator's other ways to reach a run: keys of its terminal, and a socket in its folder.

They stop any run. A run that is steered takes the words of `hil.steering` from them too.
"""

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
from functools import partial
from pathlib import Path
from typing import Protocol

from hil.errors import InputError
from hil.steering.keys import HINT as STEERING_HINT
from hil.steering.keys import STEERING_KEYS, KeyReader
from hil.steering.steering import Steering
from hil.steering.words import Word, parse_word

SOCKET = "stop"
"""Name of the socket in the run folder."""
HINT = "space: torque off now; q or Ctrl-C: sit down\n"
KEYS = {b" ": True, b"q": False}
"""Key to whether it means now."""
WORDS = {b"off": True, b"sit": False}
ANSWER_TIMEOUT_S = 0.5
CLIENT_TIMEOUT_S = 0.05
"""A client that says nothing must not keep a key from being heard."""

LINE = 128
"""Longest line of a client or of the view [bytes]."""
TYPED = 4096
"""Most that a terminal holds of what was typed [bytes] (termios(3), canonical mode)."""

Source = Callable[[], bool]
"""Serves what is readable; False when there will be nothing more."""
Say = Callable[[Word], None] | None
"""Takes a steering word; none where nobody steers."""


class Post(Protocol):
    """Takes a request to stop, from any thread."""

    def __call__(self, name: str, *, now: bool) -> None:
        """`name` of who asked; `now`: torque off at once."""
        ...


class StopListener:
    """A thread that sleeps until a key is pressed or a client connects: the tick pays nothing.

    Keys count while standard input is a terminal that this process has in the foreground. The
    socket belongs to its user (0600) and knows two words: `off` and `sit`; it answers `ok`. With
    steering, keys and socket know those words too, and a gamepad and the live view are heard.
    """

    def __init__(self, folder: Path, steering: Steering | None = None) -> None:
        """`folder` exists; the socket is there while `listening` lasts."""
        self._folder, self._steering = folder, steering

    @contextmanager
    def listening(self, post: Post) -> Iterator[None]:
        """Hand what the operator asks for to `post` for the block; in the main thread only."""
        with ExitStack() as stack:
            ending, end = socket.socketpair()
            stack.enter_context(ending)
            sources: dict[int, Source] = {}
            early: Callable[[], None] | None = None
            steering = self._steering
            helm = None if steering is None else steering.helm
            say = None if helm is None else helm.post
            if _has_terminal():
                stack.enter_context(_single_keys())
                reader = KeyReader()
                sources[sys.stdin.fileno()] = lambda: _take_keys(reader, post, say)
                early = partial(_hear, reader, _typed(), post, None)
                sys.stderr.write(HINT + ("" if say is None else STEERING_HINT))
            listener = stack.enter_context(_bound(self._folder))
            sources[listener.fileno()] = lambda: _take_client(listener, post, say)
            if steering is not None:
                sources.update(stack.enter_context(_steered(steering, post, say)))
            thread = threading.Thread(target=_listen, args=(ending, sources, early), daemon=True)
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


def _listen(
    ending: socket.socket, sources: dict[int, Source], early: Callable[[], None] | None
) -> None:
    if early is not None:
        early()
    while True:
        ready, _, _ = select.select([ending.fileno(), *sources], [], [])
        if ending.fileno() in ready:
            return
        for number in ready:
            if not sources[number]():
                del sources[number]


def _typed() -> bytes:
    """What was typed before anybody listened. It stops and never steers: a second Enter after the
    consent must not begin a walk.
    """
    number = sys.stdin.fileno()
    return _read(number) if select.select([number], [], [], 0.0)[0] else b""


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, TYPED)
    except OSError:
        return b""  # The terminal is gone, which SIGHUP tells too.


def _take_keys(reader: KeyReader, post: Post, say: Say) -> bool:
    keys = _read(sys.stdin.fileno())
    _hear(reader, keys, post, say)
    return bool(keys)


def _hear(reader: KeyReader, keys: bytes, post: Post, say: Say) -> None:
    for key in reader.keys(keys):
        if key in KEYS:
            post("key space" if key == b" " else f"key {key.decode()}", now=KEYS[key])
        elif say is not None and key in STEERING_KEYS:
            say(STEERING_KEYS[key])


@contextmanager
def _steered(steering: Steering, post: Post, say: Say) -> Iterator[dict[int, Source]]:
    """The live view's messages as a source, and the gamepad's thread, for the block."""
    view, gamepad = steering.view, steering.gamepad
    with ExitStack() as stack:
        if gamepad is not None and say is not None:
            stack.enter_context(
                gamepad.listening(say, lambda word: post("gamepad", now=WORDS[word.encode()]))
            )
        yield {} if view is None else {view.fileno(): lambda: _take_view(view, post, say)}


def _take_view(view: socket.socket, post: Post, say: Say) -> bool:
    """One message of the view; its end means that the view has died, which is no harm."""
    try:
        line = view.recv(LINE)
    except OSError:
        return False
    if line in WORDS:
        post("view", now=WORDS[line])
    elif line and say is not None:
        with suppress(InputError):  # ours on both ends: only a torn message gets here
            say(parse_word(line.decode(errors="replace")))
    return bool(line)


def _take_client(listener: socket.socket, post: Post, say: Say) -> bool:
    with suppress(OSError):  # a client that is gone again wants nothing
        client, _ = listener.accept()
        with client:
            client.settimeout(CLIENT_TIMEOUT_S)
            word = client.recv(LINE).strip()
            client.sendall(_answer(word, post, say) + b"\n")
    return True


def _answer(word: bytes, post: Post, say: Say) -> bytes:
    """Do what a client of the socket says, and the answer to it."""
    if word in WORDS:
        post("socket", now=WORDS[word])
    elif say is None:
        return b"say off or sit"
    else:
        try:
            say(parse_word(word.decode(errors="replace")))
        except InputError as error:
            return f"{error}; off and sit stop".encode()
    return b"ok"


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
