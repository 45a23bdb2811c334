"""Figures as tables on standard output."""

import os
import sys
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

PAGE_COLUMNS = 160

MAIN_FIGURES = (
    ("fell", "fell", ""),
    ("duration", "duration_s", "s"),
    ("steps", "steps", ""),
    ("distance", "distance_m", "m"),
    ("mean speed", "mean_speed_mps", "m/s"),
    ("commanded speed", "target_speed_mps", "m/s"),
    ("speed error", "speed_error_pct", "%"),
    ("heading error", "heading_error_deg", "deg"),
    ("disequilibrium", "disequilibrium_pct", "%"),
    ("controller, mean", "controller_ms_mean", "ms"),
    ("controller, p99", "controller_ms_p99", "ms"),
    ("tick, p50", "cycle_ms_p50", "ms"),
    ("tick, p99", "cycle_ms_p99", "ms"),
    ("deadlines missed", "deadline_misses", ""),
    ("real-time factor", "real_time_factor", "×"),
    ("bus utilisation", "bus_utilisation_pct", "%"),
    ("bus CRC errors", "bus_crc_errors", ""),
    ("bus timeouts", "bus_timeouts", ""),
    ("hottest servo", "temperature_max_c", "°C"),
    ("torque rms, worst servo", "torque_rms_ratio_max", "of stall"),
    ("duty saturated, worst servo", "duty_saturation_pct_max", "%"),
    ("lowest supply", "voltage_min_v", "V"),
    ("energy", "energy_wh", "Wh"),
)


def number(value: Any) -> str:
    """A figure as a person reads it."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.3f}" if isinstance(value, float) else str(value)


def print_rows(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table; columns without a head are text, the others figures."""
    table = Table(title=title, title_justify="left", header_style="bold")
    for head in heads:
        table.add_column(head, justify="right" if head else "left")
    for row in rows:
        table.add_row(*row)
    _console().print(table)


GROUND_FIGURES = (
    "distance_m",
    "mean_speed_mps",
    "target_speed_mps",
    "speed_error_pct",
    "heading_error_deg",
    "disequilibrium_pct",
)
"""What says nothing of a robot that does not walk on the ground."""


def print_report(report: dict[str, Any], rung: str = "") -> None:
    """The figures of a run that are known, and what went wrong.

    `rung`: what the robot did instead of walking on the ground.
    """
    where = report["backend"] if report["bus"] is None else f"{report['bus']} bus"
    hidden = GROUND_FIGURES if rung else ()
    what = f"{report['robot']}, {rung}" if rung else report["robot"]
    title = f"{what}, {where}, {report['rate_hz']} Hz, seed {report['seed']}"
    rows = [
        (name, number(report[key]), unit)
        for name, key, unit in MAIN_FIGURES
        if report[key] is not None and key not in hidden
    ]
    print_rows(title, ("", f"motion from {report['motion_source']}", ""), rows)
    for fault in report["faults"]:
        line = f"{fault['time_s']:.2f} s: {fault['source']}: {fault['name']} ({fault['reaction']})"
        _console().print(line, style="bold red", highlight=False)


def _console() -> Console:
    """A console that does not cut tables to 80 columns where nobody said how wide the page is."""
    unknown = not sys.stdout.isatty() and "COLUMNS" not in os.environ
    return Console(width=PAGE_COLUMNS if unknown else None)
