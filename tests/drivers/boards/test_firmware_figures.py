"""Rates, delays and ages that the firmware's documentation states, checked from another side."""

import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from drivers.boards.reader import BoardReader
from tests.drivers.boards.conftest import make, need

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "foot-board.md").read_text(encoding="utf-8")
MODULATOR_HZ = 4.096e6
HANDLING_US = 50
"""From DRDY to the first byte, as the page assumes."""
LINE = re.compile(r"^(.{34})(\S+) (\S+)$", re.MULTILINE)


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """What `make figures` prints."""
    need("make", "cc")
    return make(tmp_path_factory.mktemp("figures"), "figures")


@pytest.fixture(scope="module")
def figures(printed):
    return {name.strip(): float(value) for name, value, _ in LINE.findall(printed)}


@pytest.fixture(scope="module")
def impulse_response():
    """The filter of the data sheet as one FIR at the modulator's rate: sinc3 of 1024, mean of 4."""
    box = np.full(1024, 1 / 1024)
    mean = np.zeros(3 * 1024 + 1)
    mean[::1024] = 1 / 4
    return np.convolve(np.convolve(np.convolve(box, box), box), mean)


def response(taps, frequency):
    phase = -2j * np.pi * frequency / MODULATOR_HZ * np.arange(taps.size)
    return abs(np.exp(phase) @ taps)


def test_the_page_shows_what_the_command_prints(printed):
    lines = [line for line in printed.splitlines() if LINE.match(line)]
    assert len(lines) == 20
    assert "\n".join(lines) in PAGE


def test_the_group_delay_is_the_centre_of_the_impulse_response(figures, impulse_response):
    centre = np.arange(impulse_response.size) @ impulse_response / MODULATOR_HZ * 1e6
    assert figures["group delay of the filter"] == pytest.approx(centre, abs=0.1)


def test_the_filter_cuts_off_below_half_the_frame_rate(figures, impulse_response):
    cut_off, half = figures["filter cut-off (-3 dB)"], figures["half the frame rate"]
    assert cut_off < half
    assert response(impulse_response, cut_off) == pytest.approx(np.sqrt(0.5), rel=0.005)
    for name, frequency in (("filter at half the frame rate", half),
                            ("worst alias into 0 to 50 Hz", 2 * half - 50)):  # fmt: skip
        decibel = 20 * np.log10(response(impulse_response, frequency))
        assert figures[name] == pytest.approx(decibel, abs=0.06)


def test_the_robot_line_of_the_page_gives_the_true_age(board, figures):
    """Not twice the filter's delay, though frames carry the sample's time already."""
    (delay_us,) = (int(value) for value in re.findall(r"delay_us: (\d+)\}", PAGE))
    assert delay_us == pytest.approx(figures["delay_us"], abs=5)
    line = SimpleNamespace(data=b"")
    line.read_available = lambda: line.data
    wire_usb_us = 325.5 + 125
    reader = BoardReader(line, int((delay_us + wire_usb_us) * 1000), 1_000_000, 3_333_333)
    board.start()
    for number in range(20):
        line.data = board.sample([number] * 4)
        late_us = 20 * (7 * number % 5)
        after_ready_us = HANDLING_US + wire_usb_us + late_us
        arrival_ns = int((board.time_us + after_ready_us) * 1000)
        reader.poll(arrival_ns)
        before_ready_us = (
            figures["group delay of the filter"] + figures["delay of the analog filter"]
        )
        true_age_us = before_ready_us + after_ready_us
        assert reader.age_ns(arrival_ns) / 1000 == pytest.approx(true_age_us, abs=5)


@pytest.mark.pty
def test_the_listening_script_of_the_page_runs(avr_pty, tmp_path):
    """On the reduced firmware, whose last cell is open half of the time."""
    (script,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "listen.py").write_text(script, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(tmp_path / "listen.py"), avr_pty, "1.5"],
        env={"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "200.0 frames/s" in done.stdout
    assert "0 lost, 0 wrong CRCs" in done.stdout
    assert re.search(r"rear right +valid \d+ of", done.stdout)
