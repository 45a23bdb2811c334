"""One walk of a study, in memory: the same parts as `stride walk`, without a run folder."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hil.compose import build
from hil.cycle import Sink
from hil.errors import StrideError
from hil.gait_report import measured_from
from hil.interface import Floats, Ints
from hil.loop import Loop
from hil.request import RunRequest
from hil.robot_facts import body_weight
from hil.run import session_report
from hil.session import Session
from hil.studies.noisy_loads import NoisyLoads
from hil.trace import Trace, TraceSink

PROBE_S = 8.0
"""Length of the walks whose steps are timed [s]."""


@dataclass(frozen=True, slots=True)
class Walk:
    """What a walk left behind."""

    report: dict[str, Any]
    """As `report.json`."""
    trace: Trace

    @property
    def stopped_s(self) -> float | None:
        """Time of the fall, or of another fault that ended the walk [s]; None at its full end."""
        end = self._end()
        return None if end is None else float(end["time_s"])

    @property
    def ending(self) -> str | None:
        """Name of the fault that ended the walk: `fell`, most often."""
        end = self._end()
        return None if end is None else str(end["name"])

    def _end(self) -> dict[str, Any] | None:
        """The fault that ended the walk."""
        ends = (fault for fault in self.report["faults"] if fault["reaction"] != "none")
        return next(ends, None)


def walk(request: RunRequest, *more: Sink, cell_noise_n: float = 0.0) -> Walk:
    """A walk, with further sinks. A fall is a result; raises StrideError for what cannot run.

    `cell_noise_n` is the standard deviation of white noise on every corner force of the estimate.
    """
    session = build(request)
    if cell_noise_n > 0.0:
        noisy = NoisyLoads(session.estimator, cell_noise_n, request.seed)
        session = replace(session, estimator=noisy)
    return walk_session(session, *more)


def walk_session(session: Session, *more: Sink) -> Walk:
    """The walk of a session that is not open yet; it is closed at the end."""
    request = session.request
    try:
        session.backend.open()
        rate_hz = session.request.rate_hz or session.description.defaults.rate_hz
        sink = TraceSink(len(session.description.joints), round(request.duration_s * rate_hz))
        outcome = Loop(session, (sink, *more), sits=False).run()
        trace = sink.trace()
        weight_n = body_weight(session.description)
        report = session_report(session, outcome, trace, weight_n)
    finally:
        session.close()
    return Walk(report, trace)


def step_starts(trace: Trace) -> tuple[Floats, Ints]:
    """Times at which a step began [s] and the stance foot of each step."""
    ticks = np.flatnonzero(np.diff(trace.steps) > 0) + 1
    return trace.time_s[ticks], trace.stance[ticks]


def mean_step_time(trace: Trace) -> float:
    """Mean time of a step in the second half of a walk [s]. Raises StrideError without steps."""
    times, _ = step_starts(trace)
    times = times[len(times) // 2 :]
    if len(times) < 2:
        raise StrideError("the unperturbed walk has too few steps to be timed")
    return float((times[-1] - times[0]) / (len(times) - 1))


def lasting(request: RunRequest, steps: int) -> RunRequest | Walk:
    """The request, long enough for so many steps by the step time of its first seconds.

    If it does not come through these, the walk that ended there.
    """
    probe = walk(request.model_copy(update={"duration_s": PROBE_S}))
    if probe.stopped_s is not None:
        return probe
    duration_s = (steps + 1) * mean_step_time(probe.trace)
    return request.model_copy(update={"duration_s": duration_s})


def mean_velocity(trace: Trace) -> tuple[float, float]:
    """Sagittal and coronal COM speed over whole strides once the walk is steady [m/s].

    Coronal sway is as large as a coronal speed, so the mean begins and ends with a step of the
    same foot. NaN in a walk without two of them.
    """
    times, stance = step_starts(trace)
    left = times[(stance == 0) & (times >= measured_from(trace))]
    if len(left) < 2:
        return float("nan"), float("nan")
    begin, end = np.searchsorted(trace.time_s, (left[0], left[-1]))
    moved = np.diff(trace.com[begin : end + 1, :2], axis=0)
    cos, sin = np.cos(trace.heading[begin:end]), np.sin(trace.heading[begin:end])
    forward, left_ = cos * moved[:, 0] + sin * moved[:, 1], cos * moved[:, 1] - sin * moved[:, 0]
    span = float(left[-1] - left[0])
    return float(forward.sum()) / span, float(left_.sum()) / span


def finite(value: float) -> float | None:
    """NaN means unknown, which JSON writes as null."""
    return float(value) if np.isfinite(value) else None
