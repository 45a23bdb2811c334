"""What somebody who steers may say: a short line, the same from whichever device it comes."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from hil.errors import InputError

FORMS: Mapping[str, tuple[str, ...]] = {
    "speed": ("M/S",),
    "lateral": ("M/S",),
    "heading": ("RAD",),
    "faster": ("M/S",),
    "sideways": ("M/S",),
    "turn": ("RAD",),
    "push": ("FX", "FY", "FZ", "S"),
    "halt": (),
    "start": (),
    "alive": (),
}
"""Word to its numbers. `faster`, `sideways` and `turn` change what is asked for by so much; `halt`
asks for speed 0 on both axes; `start` begins a walk that waits; `alive` says that a hand is there.
"""


@dataclass(frozen=True, slots=True)
class Word:
    """One thing said by whoever steers."""

    name: str
    """A key of `FORMS`."""
    values: tuple[float, ...] = ()

    def line(self) -> str:
        """The word as `parse_word` reads it."""
        return " ".join([self.name, *(f"{value:.6g}" for value in self.values)])


def parse_word(text: str) -> Word:
    """A word from its line. Raises InputError naming the word, its form and the known ones."""
    name, *numbers = text.split() or [""]
    form = FORMS.get(name)
    if form is None:
        raise InputError(f"steering: {name!r} is not one of {', '.join(FORMS)}")
    try:
        values = tuple(float(number) for number in numbers)
    except ValueError:
        values = ()
    if len(values) != len(form) or not all(map(math.isfinite, values)):
        wanted = " ".join([name, *form])
        raise InputError(f"steering: {text.strip()!r} is not of the form {wanted!r}")
    return Word(name, values)
