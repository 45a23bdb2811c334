"""report.json: one flat object a run. What each key means: docs/reports.md."""

import math
from dataclasses import asdict
from typing import Any

from hil.gait_report import gait_figures, percentiles_ms
from hil.loop import Outcome
from hil.request import RunRequest
from hil.safety.severity import Fault
from hil.trace import Trace

SIGNIFICANT_DIGITS = 6
COUNTER_KEYS = ("bus_crc_errors", "bus_timeouts", "bus_stale_frames")
FIGURE_KEYS = (
    "bus_utilisation_pct",
    "temperature_max_c",
    "torque_rms_ratio_max",
    "duty_saturation_pct_max",
    "voltage_min_v",
    "energy_wh",
)
"""Keys that a backend's statistics fill, with the counters; None where it has nothing to say."""


def make_report(
    request: RunRequest,
    robot: str,
    outcome: Outcome,
    trace: Trace,
    weight_n: float,
    statistics: dict[str, float | None],
    *,
    truth: bool,
) -> dict[str, Any]:
    """The report of a run; `request` is resolved."""
    rate_hz = request.rate_hz or 0
    duration_s = len(trace) / rate_hz
    iterations, limited = trace.stabilizer_iterations, trace.stabilizer_limited
    use = request.stabilizer and len(trace) > 0
    figures = {
        "robot": robot,
        "backend": request.backend,
        "bus": request.bus,
        "rate_hz": rate_hz,
        "seed": request.seed,
        "duration_s": duration_s,
        "pd": request.pd,
        "stabilizer": request.stabilizer,
        "ankle_limit": request.ankle_limit,
        "motion_source": "truth" if truth else "estimate",
        "fell": outcome.fell,
        **gait_figures(trace, weight_n),
        **percentiles_ms("controller_ms", trace.control_ns),
        **percentiles_ms("cycle_ms", trace.cycle_ns),
        "deadline_misses": None if request.lockstep else outcome.missed,
        "real_time_factor": outcome.clock_ns / outcome.wall_ns if outcome.wall_ns else None,
        "stabilizer_iterations_mean": float(iterations.mean()) if use else None,
        "stabilizer_limit_pct": float(100.0 * limited.mean()) if use else None,
        **{key: _count(statistics.get(key)) for key in COUNTER_KEYS},
        **{key: _finite(statistics.get(key)) for key in FIGURE_KEYS},
        "faults": [asdict(fault) for fault in (*injected(request, duration_s), *outcome.faults)],
    }
    return rounded(figures)


def injected(request: RunRequest, duration_s: float) -> list[Fault]:
    """The faults that a virtual robot was given on purpose; the reactions are listed apart."""
    return [
        Fault(fault.start or 0.0, f"{fault.plane}:{fault.target}", f"injected {fault.kind}", "none")
        for fault in request.faults
        if (fault.start or 0.0) <= duration_s
    ]


def rounded(figures: dict[str, Any]) -> dict[str, Any]:
    """Figures without the dust of their computation."""
    return {key: _rounded(value) for key, value in figures.items()}


def _rounded(value: Any) -> Any:
    """A float without the dust of its computation; everything else as it is."""
    return float(f"{value:.{SIGNIFICANT_DIGITS}g}") if isinstance(value, float) else value


def _finite(value: float | None) -> float | None:
    """NaN means unknown, which JSON writes as null."""
    return None if value is None or not math.isfinite(value) else value


def _count(value: float | None) -> int | None:
    return None if value is None else round(value)
