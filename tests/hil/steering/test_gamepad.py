import math
import os
import struct
import time

import pytest

from hil.errors import InputError
from hil.steering.gamepad import Gamepad, Sticks
from hil.steering.limits import SteerLimits
from hil.steering.words import Word

LIMITS = SteerLimits(forward=0.4, backward=-0.1, sideways=0.2, push=10.0)
LB, BACK, START = 4, 6, 7


def button(number, value=1):
    """struct js_event of linux/joystick.h: u32 time, s16 value, u8 type, u8 number."""
    return struct.pack("<IhBB", 1000, value, 0x01, number)


def axis(number, share):
    return struct.pack("<IhBB", 1000, round(share * 32767), 0x02, number)


def test_nothing_moves_unless_the_button_is_held():
    sticks = Sticks(LIMITS)
    sticks.take(axis(1, -1.0))
    assert sticks.words() == []
    sticks.take(button(LB))
    assert sticks.words()[0] == Word("speed", (0.4,))
    assert sticks.take(button(LB, 0)) == [Word("halt")]
    assert sticks.words() == []


def test_sticks_reach_each_limit_and_left_is_positive():
    sticks = Sticks(LIMITS)
    for event in (button(LB), axis(1, 1.0), axis(0, -1.0), axis(3, -1.0)):
        sticks.take(event)
    speed, lateral, turn = sticks.words()
    assert speed.values[0] == pytest.approx(-0.1) and lateral.values[0] == pytest.approx(0.2)
    assert turn.name == "turn" and turn.values[0] > 0


def test_the_state_a_pad_tells_when_it_is_opened_presses_no_button():
    sticks = Sticks(LIMITS)
    assert sticks.take(struct.pack("<IhBB", 0, 1, 0x81, START)) == []
    assert sticks.take(struct.pack("<IhBB", 0, 1, 0x81, LB)) == []
    assert sticks.words() == []


def until(condition):
    end = time.monotonic() + 10
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def test_a_pad_is_read_from_its_file_and_halts_when_it_is_pulled_out(tmp_path):
    device = tmp_path / "js0"
    os.mkfifo(device)
    said, stops = [], []
    pad = Gamepad(device, LIMITS)
    with device.open("wb", buffering=0) as wire, pad.listening(said.append, stops.append):
        wire.write(button(START) + axis(1, -0.5) + button(LB))
        assert until(lambda: sum(word.name == "speed" for word in said) > 2)
        wire.write(button(BACK))
        assert until(lambda: stops == ["off"])
        wire.close()
        assert until(lambda: said[-1] == Word("halt"))
    assert said[0] == Word("start")


def test_a_pad_that_is_not_there_is_one_line(tmp_path):
    with pytest.raises(InputError, match=r"--steer .*js7: cannot be opened: No such file"):
        Gamepad(tmp_path / "js7", LIMITS)


def test_a_stick_that_trembles_turns_no_faster_than_one_that_rests(tmp_path):
    """Every tremble is an event; what is asked for goes with time, not with events."""
    device = tmp_path / "js0"
    os.mkfifo(device)
    said = []
    pad = Gamepad(device, LIMITS)
    with device.open("wb", buffering=0) as wire, pad.listening(said.append, said.append):
        began = time.monotonic()
        wire.write(button(LB))
        for number in range(100):
            wire.write(axis(3, 0.9 + 0.0005 * number))
            time.sleep(0.002)
        assert until(lambda: any(word.name == "turn" for word in said))
        lasted = time.monotonic() - began
    turned = -sum(word.values[0] for word in said if word.name == "turn")
    assert 0.0 < turned < math.radians(25.0) * (lasted + 0.1)


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/null", "notes.txt"])
def test_what_is_no_joystick_is_not_taken_for_one(name, tmp_path):
    """An event device beside it speaks another language, in which buttons would be pressed."""
    device = tmp_path / name
    if not device.exists():
        device.write_bytes(button(START))
    with pytest.raises(InputError, match="is no joystick"):
        Gamepad(device, LIMITS)
