"""Two walks side by side: figures, joints over the stride, forces, timing."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from hil.gait_report import gait_figures, measured_from, percentiles_ms
from hil.interface import Floats
from hil.recording import Recording
from hil.trace import Trace

STRIDE_BINS = 40
"""Bins over a stride: 20 over the phase of each stance foot."""


@dataclass(frozen=True, slots=True)
class Walk:
    """One of the runs that are compared."""

    name: str
    meta: dict[str, Any]
    trace: Trace

    @property
    def label(self) -> str:
        """What tells it from the other one."""
        return f"{self.name} ({self.meta['rung']})"


@dataclass(frozen=True, slots=True)
class Figure:
    """One figure of both runs."""

    key: str
    first: float | None
    second: float | None
    difference: float | None
    """Second minus first."""

    @classmethod
    def of(cls, key: str, first: float | None, second: float | None) -> "Figure":
        """A figure that each run has by itself."""
        if first is None or second is None:
            return cls(key, first, second, None)
        return cls(key, first, second, second - first)

    @property
    def difference_pct(self) -> float | None:
        """The difference in percent of the first."""
        if self.difference is None or not self.first:
            return None
        return 100.0 * self.difference / abs(self.first)


def walk_of(name: str, recording: Recording) -> Walk | None:
    """The walk in a recording; None where it holds none, as of a hoisted or a standing run."""
    trace = recording.trace()
    return Walk(name, recording.meta, trace) if len(trace) > 1 else None


def compare_walks(first: Walk, second: Walk) -> list[Figure]:
    """Every figure that both runs have."""
    a, b = _figures(first), _figures(second)
    rms = joint_rms_difference(first, second)
    figures = [Figure.of(key, a[key], b[key]) for key in a]
    return [*figures, Figure("joint_rms_difference_rad", None, None, rms)]


def stride_profile(trace: Trace, values: Floats) -> Floats:
    """Mean of values over the stride, shape (STRIDE_BINS, ...): left stance, then right.

    Ticks are sorted by stance foot and phase, so that walks of different step times can be laid
    over each other. Start-up of the walk (`gait_report.WARM_UP_S`) is left out; NaN where a bin
    has no tick.
    """
    steady = trace.walking & (trace.time_s >= measured_from(trace))
    half = STRIDE_BINS // 2
    place = np.clip((trace.phase[steady] * half).astype(int), 0, half - 1)
    place += half * trace.stance[steady]
    sums = np.zeros((STRIDE_BINS, *values.shape[1:]))
    np.add.at(sums, place, values[steady])
    counts = np.bincount(place, minlength=STRIDE_BINS).astype(float)
    counts[counts == 0] = np.nan
    return np.asarray(sums / counts.reshape(-1, *(1,) * (values.ndim - 1)))


def joint_rms_difference(first: Walk, second: Walk) -> float | None:
    """Rms over joints and phase of the difference of mean joint angles [rad]."""
    if first.meta["joints"] != second.meta["joints"]:
        return None
    profiles = [stride_profile(walk.trace, walk.trace.joint_position) for walk in (first, second)]
    difference = profiles[0] - profiles[1]
    known = np.isfinite(difference)
    return float(np.sqrt(np.mean(difference[known] ** 2))) if known.any() else None


def stance_load(trace: Trace) -> Floats:
    """Load on the stance foot [N], shape (T,)."""
    ticks = np.arange(len(trace))
    return np.asarray(trace.foot_force[ticks, trace.stance].sum(axis=1)) + np.asarray(
        trace.toe_force[ticks, trace.stance]
    )


def _figures(walk: Walk) -> dict[str, float | None]:
    trace = walk.trace
    gait = gait_figures(trace, walk.meta["weight_n"])
    walking = trace.time_s[trace.walking]
    steps = gait["steps"] or 0
    loads = trace.foot_force.sum(axis=2) + trace.toe_force
    return {
        "duration_s": float(trace.time_s[-1]),
        **gait,
        "step_time_s": float(walking[-1] - walking[0]) / steps if steps else None,
        "foot_load_mean_n": float(loads.sum(axis=1).mean()),
        "foot_load_peak_n": float(loads.max()),
        **percentiles_ms("controller_ms", trace.control_ns),
        **percentiles_ms("cycle_ms", trace.cycle_ns),
    }
