"""The panel of the loop and its bus: period, percentiles, utilisation, errors."""

from typing import Any

import numpy as np

from hil.interface import Ints
from hil.view import gui
from hil.view.live import LiveRun
from hil.view.panel_walk import WIDTH

HEIGHT = 210.0
ERRORS = (
    ("CRC errors", "bus_crc_errors"),
    ("timeouts", "bus_timeouts"),
    ("stale frames", "bus_stale_frames"),
)
FULL_PCT = 80.0
"""Utilisation from which it is coloured."""


class BusPanel:
    """What the last seconds' ticks cost, and what the bus has counted."""

    def __init__(self, rate_hz: int, live: LiveRun) -> None:
        self._rate_hz, self._live = rate_hz, live

    def build(self, desk: gui.Desk, top: float) -> None:
        """The panel of this frame, below `top`."""
        with desk.panel("Loop and bus", gui.MARGIN, top, WIDTH, HEIGHT) as shown:
            if shown:
                self._timing()
                self._counters(self._live.facts.get("statistics", {}))

    def _timing(self) -> None:
        period_ms = 1e3 / self._rate_hz
        gui.text(f"period {period_ms:.2f} ms ({self._rate_hz} Hz)")
        cycle, late = self._live.cycle_ns(), self._live.late_ns()
        if len(cycle):
            worst = gui.BAD if float(cycle.max()) > 1e6 * period_ms else gui.PLAIN
            gui.text(f"tick {_percentiles(cycle)}", worst)
            gui.text(f"late {_percentiles(late)}")
        skipped = self._live.skipped
        gui.text(f"ticks skipped {skipped}", gui.BAD if skipped else gui.DIM)

    def _counters(self, known: dict[str, Any]) -> None:
        used = known.get("bus_utilisation_pct")
        if used is None:
            gui.text("no bus on this rung", gui.DIM)
            return
        gui.text(f"bus used {used:.0f} %", gui.WARN if used > FULL_PCT else gui.PLAIN)
        for label, key in ERRORS:
            count = known.get(key) or 0
            gui.text(f"{label} {count:.0f}", gui.WARN if count else gui.DIM)
        voltage = known.get("voltage_min_v")
        if voltage is not None:
            gui.text(f"least supply {voltage:.1f} V", gui.DIM)


def _percentiles(values: Ints) -> str:
    p50, p99 = np.percentile(values, (50, 99)) * 1e-6
    return f"p50 {p50:.1f}  p99 {p99:.1f}  max {values.max() * 1e-6:.1f} ms"
