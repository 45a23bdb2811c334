"""Keys of a terminal as words: arrows and their neighbours."""

import math
from collections.abc import Mapping

from hil.steering.words import Word

SPEED_STEP = 0.02
"""[m/s] a key press."""
TURN_STEP = math.radians(5.0)
HINT = "arrows: speed and turn; , . sideways; 0: on the spot; Enter: begin, or still here\n"
"""What the keys are, for the terminal."""

STEERING_KEYS: Mapping[bytes, Word] = {
    b"\x1b[A": Word("faster", (SPEED_STEP,)),
    b"\x1b[B": Word("faster", (-SPEED_STEP,)),
    b"\x1b[D": Word("turn", (TURN_STEP,)),
    b"\x1b[C": Word("turn", (-TURN_STEP,)),
    b",": Word("sideways", (SPEED_STEP,)),
    b".": Word("sideways", (-SPEED_STEP,)),
    b"0": Word("halt"),
    b"\n": Word("start"),
    b"\r": Word("start"),
}
"""Left is positive. An arrow is an escape sequence (ECMA-48 CUU, CUD, CUB, CUF)."""
ESCAPE = b"\x1b"
APPLICATION = b"\x1bO"
"""How arrows begin on a terminal in application mode; then as after `ESC [`."""
SEQUENCE = 3
ALWAYS = b" q"
"""Keys that stop: heard inside a sequence that was cut off, too."""


class KeyReader:
    """Splits what a terminal sends into keys; a sequence that is cut off waits for its end."""

    def __init__(self) -> None:
        self._begun = b""

    def keys(self, data: bytes) -> list[bytes]:
        """The whole keys in what has arrived so far, in order."""
        found = []
        for number in data:
            byte = bytes([number])
            lone = self._begun == ESCAPE and byte not in b"[O"
            if byte == ESCAPE or lone or byte in ALWAYS:
                self._begun = b""
            if byte != ESCAPE and not self._begun:
                found.append(byte)
                continue
            self._begun += byte
            if len(self._begun) == SEQUENCE:
                found.append(self._begun.replace(APPLICATION, b"\x1b["))
                self._begun = b""
        return found
