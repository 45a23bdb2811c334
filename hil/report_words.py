"""The figures of a run as people read them: which ones first, their names and units."""

from collections.abc import Mapping
from typing import Any

MAIN_FIGURES = (
    ("fell", "fell", ""),
    ("duration", "duration_s", "s"),
    ("steps", "steps", ""),
    ("landed standing", "landed_standing", ""),
    ("landing error", "landing_error_m", "m"),
    ("apex error", "apex_error_m", "m"),
    ("take-off velocity error", "takeoff_velocity_error_mps", "m/s"),
    ("airtime", "airtime_s", "s"),
    ("feet clear the ground by", "foot_clearance_m", "m"),
    ("largest torque", "peak_joint_torque_ratio", "of its limit"),
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
"""Name, key in report.json, unit."""

GROUND_FIGURES = (
    "distance_m",
    "mean_speed_mps",
    "target_speed_mps",
    "speed_error_pct",
    "heading_error_deg",
    "disequilibrium_pct",
)
"""What says nothing of a robot that does not walk on the ground."""
ON_THE_GROUND = ("simulation", "dry run", "live")
"""Rungs on which a robot walks on the ground."""


def main_figures(report: Mapping[str, Any], *, on_the_ground: bool) -> list[tuple[str, str, str]]:
    """Main figures that are known: name, value, unit."""
    hidden = () if on_the_ground else GROUND_FIGURES
    return [
        (name, number(report[key]), unit)
        for name, key, unit in MAIN_FIGURES
        if report.get(key) is not None and key not in hidden
    ]


def number(value: Any) -> str:
    """A figure as a person reads it."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
