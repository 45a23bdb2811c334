import math

import pytest

from hil.steering.keys import SPEED_STEP, STEERING_KEYS, TURN_STEP, KeyReader
from hil.steering.words import Word


def words(*chunks):
    reader = KeyReader()
    found = [key for chunk in chunks for key in reader.keys(chunk)]
    return [STEERING_KEYS[key] for key in found if key in STEERING_KEYS]


@pytest.mark.parametrize("begin", [b"\x1b[", b"\x1bO"])
def test_arrows_in_both_modes_of_a_terminal(begin):
    up, down, right, left = (words(begin + final)[0] for final in (b"A", b"B", b"C", b"D"))
    assert up == Word("faster", (SPEED_STEP,)) and down.values[0] == -SPEED_STEP
    assert left == Word("turn", (TURN_STEP,)) and right.values[0] == -TURN_STEP
    assert math.degrees(TURN_STEP) == pytest.approx(5)


def test_an_arrow_in_three_pieces_is_one_arrow():
    assert words(b"\x1b", b"[", b"A\x1b[A") == [Word("faster", (SPEED_STEP,))] * 2


@pytest.mark.parametrize("before", [b"", b"\x1b", b"\x1b[", b"\x1bO", b"\x1b\x1b["])
@pytest.mark.parametrize("key", [b" ", b"q"])
def test_a_key_that_stops_is_heard_wherever_it_comes(before, key):
    assert key in KeyReader().keys(before + key)


def test_other_keys_say_nothing():
    assert words(b"\x1b[Hxyz\x1b[5~\t") == []
