"""What all tests share: the width of the page, and who runs beside whom (`pytest -n 2`)."""

import os
from pathlib import Path

import pytest

HERE = Path(__file__).parent
REAL_TIME = (
    "contract",
    "drivers",
    "hil/bringup",
    "hil/steering",
    "hil/test_clock.py",
    "hil/test_recorder.py",
    "hil/test_stops.py",
    "hil/test_timing.py",
    "hil/view",
    "safety",
    "sim_backends/virtual",
)
"""What waits for a wall clock, often beside a process of its own: one after the other, or they
would take the cores from each other."""
BROWSER = "hil/view/test_chromium.py"
"""Draws in software on every core there is. Groups of one test come last, when there is room."""
TOGETHER = ("docs",)
"""Folders whose tests share what takes long to make."""


def pytest_configure() -> None:
    """Tables are as wide as a page, whatever terminal the tests run in."""
    os.environ.pop("COLUMNS", None)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """A group for every test: its file, unless the file belongs to a larger one."""
    for item in items:
        item.add_marker(pytest.mark.xdist_group(_group(item.path.relative_to(HERE).as_posix())))


def _group(file: str) -> str:
    if file.startswith(REAL_TIME) and file != BROWSER:
        return "real time"
    return next((folder for folder in TOGETHER if file.startswith(folder)), file)
