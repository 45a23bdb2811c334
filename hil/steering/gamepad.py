"""A gamepad on the Linux joystick interface (`/dev/input/js*`), as words.

Numbers of axes and buttons are those of the kernel's xpad driver, which most pads speak
(Documentation/input/gamepad.rst); read from the device file, without a library.
"""

import fcntl
import math
import os
import select
import stat
import struct
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hil.errors import InputError
from hil.steering.limits import SteerLimits
from hil.steering.words import Word
from hil.timing import stopwatch_ns

EVENT = struct.Struct("<IhBB")
"""Time [ms], value, type, number (linux/joystick.h, js_event)."""
BUTTON, AXIS, INITIAL = 0x01, 0x02, 0x80
FULL = 32767.0
DEAD_ZONE = 0.12
"""Share of the way in which a stick counts as let go."""
LEFT_X, LEFT_Y, RIGHT_X = 0, 1, 3
HOLD, SIT, OFF, START = 4, 1, 6, 7
"""LB, B, Back and Start."""
JSIOCGVERSION = 0x80046A01
"""Asks a device for the version of its joystick driver (linux/joystick.h)."""
PERIOD_S = 0.05
TURN_RATE = math.radians(25.0)
"""At full deflection [rad/s]."""

PostWord = Callable[[Word], None]


class Sticks:
    """What a pad's sticks and buttons ask for; the robot moves while LB is held.

    Left stick: speed and sideways speed, in shares of the limits. Right stick: turning.
    """

    def __init__(self, limits: SteerLimits) -> None:
        self._limits = limits
        self._axes: dict[int, float] = {}
        self._held = False
        self.stop: str | None = None
        """`sit` or `off`, once that button was pressed."""

    def take(self, event: bytes) -> list[Word]:
        """The words of one js_event; a stick's come from `words`, while it is held."""
        _, value, kind, number = EVENT.unpack(event)
        if kind & AXIS:
            self._axes[number] = value / FULL if abs(value) > DEAD_ZONE * FULL else 0.0
        elif kind == BUTTON and number == HOLD:
            self._held = bool(value)
            return [] if self._held else [Word("halt")]
        elif kind == BUTTON and value:
            if number == START:
                return [Word("start")]
            self.stop = {SIT: "sit", OFF: "off"}.get(number, self.stop)
        return []

    def words(self) -> list[Word]:
        """What is asked for now; to be said every `PERIOD_S`."""
        if not self._held:
            return []
        forward, left = -self._axis(LEFT_Y), -self._axis(LEFT_X)
        most = self._limits.forward if forward > 0.0 else -self._limits.backward
        words = [
            Word("speed", (forward * most,)),
            Word("lateral", (left * self._limits.sideways,)),
        ]
        turn = -self._axis(RIGHT_X) * TURN_RATE * PERIOD_S
        return [*words, Word("turn", (turn,))] if turn else words

    def _axis(self, number: int) -> float:
        return self._axes.get(number, 0.0)


class Gamepad:
    """A thread that reads one pad. A pad that is pulled out stops the robot on the spot."""

    def __init__(self, device: Path, limits: SteerLimits) -> None:
        """Opens the device, or a pipe that carries such events. Raises InputError."""
        self._sticks = Sticks(limits)
        try:
            self._number = os.open(device, os.O_RDONLY | os.O_NONBLOCK)
        except OSError as error:
            raise InputError(
                f"--steer {device}: cannot be opened: {error.strerror}; gamepads are "
                "/dev/input/js0 and so on, and want membership of the group `input`"
            ) from error
        if not _speaks_events(self._number):
            os.close(self._number)
            raise InputError(
                f"--steer {device}: is no joystick; those are /dev/input/js0 and so on"
            )

    @contextmanager
    def listening(self, post: PostWord, stop: Callable[[str], None]) -> Iterator[None]:
        """Hand words to `post`, and `sit` or `off` to `stop`, for the block."""
        ending, end = os.pipe()
        thread = threading.Thread(target=self._listen, args=(ending, post, stop), daemon=True)
        thread.start()
        try:
            yield
        finally:
            os.close(end)
            thread.join()
            os.close(ending)
            os.close(self._number)

    def _listen(self, ending: int, post: PostWord, stop: Callable[[str], None]) -> None:
        sources = [ending, self._number]
        said_ns = 0
        while True:
            ready, _, _ = select.select(sources, [], [], PERIOD_S)
            if ending in ready:
                return
            if self._number in ready and not self._read(post):
                post(Word("halt"))
                sources.remove(self._number)
            # A stick that trembles sends events all the time: a turn goes with time, not with them.
            if self._number in sources and stopwatch_ns() - said_ns >= PERIOD_S * 1e9:
                said_ns = stopwatch_ns()
                for word in self._sticks.words():
                    post(word)
            if self._sticks.stop is not None:
                stop(self._sticks.stop)
                self._sticks.stop = None

    def _read(self, post: PostWord) -> bool:
        """Take what the pad has sent; False when it is gone."""
        try:
            data = os.read(self._number, 64 * EVENT.size)
        except OSError:
            return False
        for begin in range(0, len(data) - EVENT.size + 1, EVENT.size):
            for word in self._sticks.take(data[begin : begin + EVENT.size]):
                post(word)
        return bool(data)


def _speaks_events(number: int) -> bool:
    """Whether js_events come from an open file: from a pipe, or from a joystick's driver."""
    if stat.S_ISFIFO(os.fstat(number).st_mode):
        return True
    try:
        fcntl.ioctl(number, JSIOCGVERSION, bytes(4))
    except OSError:
        return False
    return True
