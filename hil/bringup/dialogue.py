"""Talking with whoever holds the robot: sentences, waiting for Enter, nothing that blocks."""

import io
import os
import select
import sys
import textwrap
from collections.abc import Callable
from typing import Protocol

from hil.bringup.deed import Deed
from hil.errors import InputError

WIDTH = 92
"""Columns of a sentence."""


class Dialogue(Protocol):
    """What calibration needs of a person."""

    def say(self, text: str, *deeds: Deed) -> None:
        """Tell something, and what hands are to do, one deed after another."""
        ...

    def ask(self, text: str, *deeds: Deed) -> None:
        """The same, to be answered with Enter when it is done."""
        ...

    def answered(self) -> bool:
        """Whether Enter came since it was asked; returns at once. Raises InputError."""
        ...


class TerminalDialogue:
    """Standard input and output; input may be a file or a pipe with a line for each question."""

    def __init__(self) -> None:
        self._buffer = b""

    def say(self, text: str, *deeds: Deed) -> None:
        """Print; hands are the reader's own."""
        del deeds
        indent = " " * (len(text) - len(text.lstrip()))
        sys.stdout.write(textwrap.fill(text, WIDTH, subsequent_indent=indent) + "\n")
        sys.stdout.flush()

    def ask(self, text: str, *deeds: Deed) -> None:
        """Print, and what is awaited."""
        self.say(f"{text} [Enter]", *deeds)

    def answered(self) -> bool:
        """A whole line has come. Raises InputError at the end of the input."""
        try:
            number = sys.stdin.fileno()
        except (io.UnsupportedOperation, ValueError, AttributeError):
            return self._take(sys.stdin.readline().encode())
        if b"\n" not in self._buffer and select.select([number], [], [], 0)[0]:
            return self._take(os.read(number, 4096))
        return b"\n" in self._buffer and self._take(b"", more=True)

    def _take(self, data: bytes, more: bool = False) -> bool:
        if not data and not more:
            raise InputError("standard input ended before the calibration did: nothing is written")
        line, end, rest = (self._buffer + data).partition(b"\n")
        self._buffer = rest if end else line
        return bool(end)


class HandDialogue:
    """A virtual robot's own hand does what is said, and answers when it is done."""

    def __init__(self, told: Dialogue, hand: Callable[[Deed], float]) -> None:
        """`told` hears everything too; `hand` begins a deed and says how long it is busy [s]."""
        self._told, self._hand = told, hand
        self._waiting: list[Deed] = []

    def say(self, text: str, *deeds: Deed) -> None:
        """Begin with the deeds."""
        self._told.say(text)
        if deeds:
            self._waiting = list(deeds)
            self._hand(self._waiting.pop(0))

    def ask(self, text: str, *deeds: Deed) -> None:
        """The same; its Enter comes when all is done."""
        self.say(text, *deeds)

    def answered(self) -> bool:
        """Whether all deeds are done; begins with the next one."""
        if self._hand(Deed()) > 0.0:
            return False
        if self._waiting:
            self._hand(self._waiting.pop(0))
            return False
        return True
