"""Figures of a walk from its trace. Definitions for readers: docs/reports.md."""

import numpy as np

from hil.interface import Bools, Floats
from hil.trace import Trace

WARM_UP_S = 5.0
"""Mean speeds begin here; in a walk shorter than twice that, at its half."""
LOADED_STANCE = 0.145
"""Share of the weight on the stance foot that makes it loaded (100 N of 70.4 kg, seed
000_bd1305a0ae731442)."""
SIDE_SHARE = 0.15
"""Share of a foot's load below which a side is in disequilibrium (same seed)."""
FLAT_CORNER = 0.0145
"""Share of the weight that makes a corner loaded (10 N of 70.4 kg, same seed)."""
MID_STANCE = (0.060, 0.9)
"""Mid-stance begins so long after a step began [s] and ends at this phase."""
NANOSECONDS_PER_MS = 1e6


def gait_figures(trace: Trace, weight_n: float) -> dict[str, float | int | None]:
    """Distance, speeds, heading error, steps and disequilibrium; None where undefined."""
    if len(trace) < 2:
        keys = ("distance_m", "mean_speed_mps", "target_speed_mps", "speed_error_pct")
        nothing = dict.fromkeys((*keys, "heading_error_deg", "disequilibrium_pct"))
        return {"steps": 0, **nothing}
    mean, target = mean_speed(trace)
    return {
        "steps": int(trace.steps[-1]),
        "distance_m": float(np.hypot(*(trace.com[-1] - trace.com[0])[:2])),
        "mean_speed_mps": mean,
        "target_speed_mps": target,
        "speed_error_pct": None if target == 0 else 100.0 * (mean - target) / abs(target),
        "heading_error_deg": heading_error(trace),
        "disequilibrium_pct": disequilibrium(trace, weight_n),
    }


def measured_from(trace: Trace) -> float:
    """Time from which mean speeds are taken [s]."""
    return min(WARM_UP_S, float(trace.time_s[-1]) / 2)


def mean_speed(trace: Trace) -> tuple[float, float]:
    """Mean COM speed along the commanded heading and mean commanded speed [m/s]."""
    begin = int(np.searchsorted(trace.time_s, measured_from(trace)))
    time, com, heading = trace.time_s[begin:], trace.com[begin:], trace.heading[begin:]
    moved = np.diff(com[:, 0]) * np.cos(heading[1:]) + np.diff(com[:, 1]) * np.sin(heading[1:])
    return float(moved.sum() / (time[-1] - time[0])), float(trace.speed[begin:].mean())


def heading_error(trace: Trace) -> float:
    """Mean of base yaw minus commanded heading over the last two steps [deg], in ±180."""
    last_two = trace.steps >= trace.steps[-1] - 2
    error = (trace.yaw - trace.heading)[last_two]
    return float(np.degrees(np.angle(np.exp(1j * error).mean())))


def disequilibrium(trace: Trace, weight_n: float) -> float | None:
    """Share of loaded-stance ticks after foot-flat in which a side carries < 15 % [%]."""
    counted, unbalanced = disequilibrium_ticks(trace, weight_n)
    return float(100.0 * unbalanced[counted].mean()) if counted.any() else None


def disequilibrium_ticks(trace: Trace, weight_n: float) -> tuple[Bools, Bools]:
    """Ticks that count, and ticks in which a side carries too little; shape (T,) each.

    Left and right are compared without the toe, front and rear with it.
    """
    ticks = np.arange(len(trace))
    corners, toe = trace.foot_force[ticks, trace.stance], trace.toe_force[ticks, trace.stance]
    front_left, front_right, rear_left, rear_right = corners.T
    sole = corners.sum(axis=1)
    counted = trace.walking & trace.foot_flat & (sole + toe > LOADED_STANCE * weight_n) & (sole > 0)
    sides = (
        _share(front_left + rear_left, sole),
        _share(front_right + rear_right, sole),
        _share(front_left + front_right + toe, sole + toe),
        _share(rear_left + rear_right, sole + toe),
    )
    return counted, np.min(sides, axis=0) < SIDE_SHARE


def flat_mid_stance(trace: Trace, weight_n: float) -> float | None:
    """Share of mid-stance ticks in which three corners of the stance foot are loaded [%].

    Counted from when mean speeds are; None without such ticks.
    """
    if len(trace) < 2:
        return None
    began = np.maximum.accumulate(
        np.where(np.diff(trace.steps, prepend=trace.steps[0]) != 0, trace.time_s, trace.time_s[0])
    )
    counted = trace.walking & (trace.phase < MID_STANCE[1])
    counted &= (trace.time_s - began > MID_STANCE[0]) & (trace.time_s >= measured_from(trace))
    corners = trace.foot_force[np.arange(len(trace)), trace.stance][counted]
    flat = np.count_nonzero(corners > FLAT_CORNER * weight_n, axis=1) >= 3
    return float(100.0 * flat.mean()) if len(flat) else None


def percentiles_ms(name: str, durations_ns: np.ndarray) -> dict[str, float | None]:
    """`name_mean`, `_p50`, `_p99` and `_max` [ms]; None without a tick."""
    keys = ("mean", "p50", "p99", "max")
    if not len(durations_ns):
        return {f"{name}_{key}": None for key in keys}
    milliseconds = durations_ns / NANOSECONDS_PER_MS
    middle, high = np.percentile(milliseconds, (50, 99))
    values = (milliseconds.mean(), middle, high, milliseconds.max())
    return {f"{name}_{key}": float(value) for key, value in zip(keys, values, strict=True)}


def _share(part: Floats, whole: Floats) -> Floats:
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)
