"""foot_board.ino itself, compiled against a stand-in Arduino: setup, interrupt, loop, restarts."""

import ctypes
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest

from drivers.boards.frames import FrameReader
from tests.drivers.boards.conftest import FIRMWARE, need
from tests.drivers.boards.fake_adc import CLOCK, FakeAdc

STAND_IN = Path(__file__).parent / "arduino"
SKETCH = FIRMWARE / "foot_board"
STRICT = ("-Wall", "-Wextra", "-Werror", "-fPIC")
HIGH, FALLING = 1, 1


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The sketch and its C files as one shared library; a C++ compiler reads the headers."""
    need("cc", "c++")
    build = tmp_path_factory.mktemp("sketch")
    objects = []
    for source in sorted(SKETCH.glob("*.c")):
        objects.append(str(build / f"{source.stem}.o"))
        compile_c = ("cc", "-std=c99", "-pedantic", *STRICT, "-c", str(source), "-o", objects[-1])
        subprocess.run(compile_c, check=True)
    out = build / "sketch.so"
    include = (f"-I{STAND_IN}", f"-I{SKETCH}")
    link = ("c++", "-std=c++17", *STRICT, *include, "-shared", "-o", str(out))
    subprocess.run([*link, str(STAND_IN / "sketch.cpp"), *objects], check=True)
    return out


class Sketch:
    """The board's processor: time, pins and ports around setup() and loop()."""

    def __init__(self, path):
        self._library = ctypes.CDLL(str(path))
        self.adc = FakeAdc()
        self.sent = b""
        self._out = self._in = b""
        spi = ctypes.CFUNCTYPE(ctypes.c_uint8, ctypes.c_uint8)(self._transfer)
        select = ctypes.CFUNCTYPE(None, ctypes.c_int)(self._select)
        sent = ctypes.CFUNCTYPE(None, ctypes.POINTER(ctypes.c_uint8), ctypes.c_size_t)(self._send)
        self._hooks = {"on_spi": spi, "on_select": select, "on_sent": sent}
        for name, hook in self._hooks.items():
            ctypes.c_void_p.in_dll(self._library, name).value = ctypes.cast(
                hook, ctypes.c_void_p
            ).value

    def __getitem__(self, name):
        return ctypes.c_int32.in_dll(self._library, name).value

    def __setitem__(self, name, value):
        ctypes.c_uint32.in_dll(self._library, name).value = value

    def _select(self, level):
        if level != HIGH:
            self._out, self._in = b"", self.adc.begin()
        elif self._out:
            self.adc.end(self._out)

    def _transfer(self, out):
        self._out += bytes((out,))
        return self._in[len(self._out) - 1]

    def _send(self, data, size):
        self.sent += bytes(data[:size])

    def setup(self):
        self["now_us"] = 1_000_000
        self._library.sketch_setup()

    def loop(self, later_us=10):
        self["now_us"] = self["now_us"] + later_us
        self._library.sketch_loop()
        assert self["interrupts_off"] == 0

    def conversion(self, counts):
        """One conversion, its DRDY, and the loop that sees it."""
        self.adc.convert(counts)
        self["now_us"] = self["now_us"] + 1000
        self._library.sketch_ready()
        self.loop()


@pytest.fixture
def sketch(library):
    made = Sketch(library)
    made.setup()
    return made


def noise(number):
    return [number * 11 + cell for cell in range(4)]


def test_setup_opens_the_port_and_configures_the_adc(sketch):
    assert sketch["baud"] == 921600
    assert sketch["spi_mode"] == 1
    assert 4_000_000 <= sketch["spi_hz"] <= 25_000_000
    assert sketch["ready_edge"] == FALLING
    assert sketch.adc.registers[CLOCK] == 0x0F16


def test_each_ready_gives_one_frame_of_its_time(sketch):
    for number in range(60):
        sketch.conversion(noise(number))
        sketch.loop()
        sketch.loop()
    frames = FrameReader().feed(sketch.sent)
    assert [frame.counts for frame in frames] == [tuple(noise(i)) for i in range(60)]
    gaps = {b.device_time_us - a.device_time_us for a, b in pairwise(frames)}
    assert gaps == {1030}
    assert frames[-1].status == 0b1111
    assert sketch["led"] == HIGH


def test_without_ready_the_adc_is_started_again(sketch):
    starts = sketch.adc.resets
    sketch.conversion(noise(1))
    sketch.loop(99_000)
    assert sketch.adc.resets == starts
    sketch.loop(2_000)
    assert sketch.adc.resets == starts + 1
    sketch.conversion(noise(2))
    frames = FrameReader().feed(sketch.sent)
    assert frames[-1].sequence == frames[-2].sequence + 1


def test_an_adc_that_lost_its_registers_is_started_again(sketch):
    sketch.conversion(noise(1))
    starts = sketch.adc.resets
    sketch.adc.power_up()
    sketch.conversion(noise(2))
    sketch.conversion(noise(3))
    assert sketch.adc.resets == starts + 1
    assert sketch.adc.registers[CLOCK] == 0x0F16
