"""The firmware's portable C part as a shared library, compiled by the host's compiler."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.drivers.boards.fake_adc import FakeAdc

FIRMWARE = Path(__file__).parents[3] / "drivers" / "boards" / "firmware"

FOUR = 4
FRAME_SIZE = 30

Transfer = ctypes.CFUNCTYPE(
    None,
    ctypes.c_void_p,
    ctypes.POINTER(ctypes.c_uint8),
    ctypes.POINTER(ctypes.c_uint8),
    ctypes.c_size_t,
)
Wait = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_uint32)


class Adc(ctypes.Structure):
    """`struct ads131m04`."""

    _fields_ = [
        ("transfer", Transfer),
        ("wait", Wait),
        ("context", ctypes.c_void_p),
        ("settling", ctypes.c_uint8),
        ("bad_frames", ctypes.c_uint8),
        ("restarted", ctypes.c_uint8),
        ("resynced", ctypes.c_uint8),
    ]


class Sample(ctypes.Structure):
    """`struct ads131m04_sample`."""

    _fields_ = [
        ("status", ctypes.c_uint16),
        ("counts", ctypes.c_int32 * FOUR),
        ("valid", ctypes.c_uint8),
    ]


class Check(ctypes.Structure):
    """`struct cell_check`."""

    _fields_ = [
        ("last", ctypes.c_int32 * FOUR),
        ("same", ctypes.c_uint8 * FOUR),
        ("good", ctypes.c_uint8 * FOUR),
    ]


class Core(ctypes.Structure):
    """`struct foot_core`."""

    _fields_ = [
        ("adc", Adc),
        ("check", Check),
        ("sequence", ctypes.c_uint16),
        ("last_drdy_us", ctypes.c_uint32),
        ("has_sample", ctypes.c_uint8),
    ]


def need(*tools):
    """Skip where a tool of the build is missing."""
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")


def make(build, *targets):
    """Build targets of the firmware's Makefile into a folder; warnings are errors."""
    command = ["make", "-C", str(FIRMWARE), f"BUILD={build}", *targets]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def firmware(tmp_path_factory):
    """The library, its functions with types."""
    need("make", "cc")
    build = tmp_path_factory.mktemp("firmware")
    make(build, "host")
    library = ctypes.CDLL(str(build / "libfoot.so"))
    library.crc16_ccitt_false.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
    library.crc16_ccitt_false.restype = ctypes.c_uint16
    library.foot_frame_encode.argtypes = [
        *(ctypes.c_char_p, ctypes.c_uint16, ctypes.c_uint32, ctypes.c_uint16),
        ctypes.POINTER(ctypes.c_int32),
    ]
    library.foot_core_sample.argtypes = [ctypes.POINTER(Core), ctypes.c_uint32, ctypes.c_char_p]
    library.foot_core_sample.restype = ctypes.c_uint8
    library.foot_core_is_lost.restype = ctypes.c_uint8
    return library


class Board:
    """A foot board of the C code with a fake ADC on its SPI."""

    def __init__(self, library):
        self._library = library
        self.adc = FakeAdc()
        self.core = Core()
        self._callbacks = Transfer(self._transfer), Wait(lambda *_: None)
        self.core.adc.transfer, self.core.adc.wait = self._callbacks
        self.time_us = 5_000_000

    def _transfer(self, _, out, back, size):
        answer = self.adc.exchange(bytes(out[:size]))
        ctypes.memmove(back, answer, size)

    def start(self):
        """Result of foot_core_start."""
        return self._library.foot_core_start(ctypes.byref(self.core))

    def answer(self):
        """The frame with which the board answers a DRDY now."""
        frame = ctypes.create_string_buffer(FRAME_SIZE)
        self._library.foot_core_sample(ctypes.byref(self.core), self.time_us, frame)
        return frame.raw

    def sample(self, counts, periods=1):
        """The frame of one conversion, `periods` after the last one."""
        self.time_us = (self.time_us + 1000 * periods) % 2**32
        self.adc.convert(counts)
        return self.answer()

    @property
    def is_lost(self):
        return bool(self._library.foot_core_is_lost(ctypes.byref(self.core)))


@pytest.fixture
def board(firmware):
    """A board that was never started."""
    return Board(firmware)


@pytest.fixture
def avr_pty(tmp_path):
    """Name of a pty with the UART of the reduced firmware, which runs in simavr."""
    need("make", "cc", "avr-gcc")
    if not Path("/usr/include/simavr/sim_avr.h").exists():
        pytest.skip("not installed: libsimavr-dev")
    make(tmp_path, "avr", "simavr")
    command = [str(tmp_path / "simavr_pty"), str(tmp_path / "foot_avr.elf")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield next(line.split()[1] for line in process.stdout if line.startswith("pty "))
        finally:
            process.terminate()
