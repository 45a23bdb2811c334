"""The web view in a real browser: it draws, a slider steers, the stop stops, strangers cannot."""

import json
import re
import time
from io import BytesIO
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from view_browser import browser, find_browser
from view_runs import Run

from hil.recording import read_recording

WIDTH, HEIGHT = 900, 640
START, STOP = (80, 77), (150, 50)
"""Middle of two buttons of the panel `Walk` [pixels]."""
SPEED_SLIDER = (150, 106)
SMALL, FLAT = 560, 360
"""Size of the second browser: it draws at the same time."""
STEAL, REQUEST = (SMALL - 208, FLAT - 16), (SMALL - 92, FLAT - 16)
"""Where Studio offers control to those who look on."""
DRAW_S = 120.0
PICTURES = Path(__file__).parents[3] / ".pytest_cache" / "view"

pytestmark = pytest.mark.skipif(
    find_browser() is None, reason="no Chromium here: `apt-get install chromium` brings one"
)


def orange(png, columns=slice(310, 500)):
    """Pixels of the minibiped's shell in the middle of the picture."""
    picture = matplotlib.image.imread(BytesIO(png))[:, columns, :3]
    red, green, blue = (picture[..., k] for k in range(3))
    return int(np.sum((red > 0.45) & (green < 0.75 * red) & (blue < 0.35 * red)))


def red(png):
    """Pixels of the panel's stop button."""
    picture = matplotlib.image.imread(BytesIO(png))[40:60, 20:290, :3]
    return int(np.sum((picture[..., 0] > 0.6) & (picture[..., 1] < 0.3)))


def until(condition, what):
    end = time.monotonic() + DRAW_S
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.5)
    raise AssertionError(f"waited {DRAW_S:.0f} s for {what}")


def press_until(condition, page, place):
    """As a person does: a browser that draws slower than one clicks may miss a click."""
    end = time.monotonic() + DRAW_S
    while not condition() and time.monotonic() < end:
        page.press(*place)
        pause = time.monotonic() + 10.0
        while not condition() and time.monotonic() < pause:
            time.sleep(0.2)
    assert condition()


@pytest.fixture
def run(tmp_path):
    run = Run(tmp_path / "run", "--duration", "300")
    yield run
    run.kill()


def test_a_person_starts_steers_and_stops_the_dry_run_and_a_stranger_cannot(run, tmp_path):
    PICTURES.mkdir(parents=True, exist_ok=True)
    steer, watch = run.said(r"steer: (http\S+)\s"), run.said(r"watch: (http\S+)\s")
    with browser(tmp_path / "one", WIDTH, HEIGHT) as page:
        page.open(steer)
        until(lambda: orange(page.picture()) > 300 and red(page.picture()) > 1000, "the picture")
        assert "token" not in page.evaluate("document.location.href")
        press_until(lambda: re.search(r"\d steps", run.text()), page, START)
        for _ in range(2):
            page.press(*SPEED_SLIDER)
        page.picture(PICTURES / "steering.png")
        _stranger_looks_on(run, watch, tmp_path)
        press_until(lambda: run.process.poll() is not None, page, STOP)
        assert run.end() == 1
    report = json.loads((run.folder / "report.json").read_text())
    assert [(f["source"], f["name"], f["reaction"]) for f in report["faults"]][-1] == (
        "operator",
        "view",
        "torque_off",
    )
    rows = read_recording(run.folder).rows
    speeds = rows["reference"]["speed"][rows["time_s"] >= 0]
    assert speeds[0] == pytest.approx(0.15)  # the robot's default
    assert 0.18 < speeds[-1] < 0.28  # where the slider was pressed


def _stranger_looks_on(run, watch, tmp_path):
    """A second browser, without the token: it sees the robot, and its clicks do nothing."""
    with browser(tmp_path / "two", SMALL, FLAT) as page:
        page.open(watch)
        until(lambda: orange(page.picture(), slice(None)) > 100, "the spectator's picture")
        for place in (STEAL, REQUEST, STOP, START):
            page.press(*place)
        seen = page.picture(PICTURES / "watching.png")
        assert red(seen) == 0  # no panels
    steps = int(re.findall(r"(\d+) steps", run.text())[-1])
    until(lambda: int(re.findall(r"(\d+) steps", run.text())[-1]) > steps + 1, "more steps")
    assert run.process.poll() is None
