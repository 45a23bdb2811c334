"""One servo moved a little way and back: slowly first, then in sharp steps, and recorded."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from hil.bringup.facts import JogSample
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.errors import BackendError
from hil.signals import StopSignals

PERIOD_NS = 10_000_000
"""Between two looks [ns]; a slow adapter makes it longer."""
HOLD_S = 0.8
"""At each place."""
STRAY_DEG = 10.0
"""Beyond the farthest goal: something pulls the servo, or it runs the wrong way."""
_MOVED_DEG = 0.2
"""Two counts: it moves."""


@dataclass(frozen=True, slots=True)
class JogRequest:
    """What is asked of the servo."""

    reach_deg: float
    effort: float
    """Share of full duty."""
    speed_dps: float
    sharp: bool
    """Whether steps without a profile follow the slow movement."""


@dataclass(frozen=True, slots=True)
class StepFigures:
    """How the servo answered one sharp step."""

    from_deg: float
    to_deg: float
    dead_time_ms: float | None
    """Until it had moved by two counts; none if it never did, as the others."""
    rise_time_ms: float | None
    """From 10 to 90 % of the way."""
    overshoot_pct: float
    rest_error_deg: float
    """Goal minus where it came to rest."""


@dataclass(slots=True)
class JogRecord:
    """All looks of one jog."""

    samples: list[JogSample] = field(default_factory=list)
    sharp_from: int | None = None
    """Index of the first look in a sharp step; none without sharp steps."""


Servo = commissioning.OneServo


@contextmanager
def movable_servo(port: str, servo_id: int, baud: int | None, reach_deg: float) -> Iterator[Servo]:
    """A servo that may be moved, on its open port. Raises InputError, PortError, BackendError."""
    commissioning.check_bauds([] if baud is None else [baud])
    line = commissioning.open_line(port, MonotonicClock())
    try:
        commissioning.find_servo(line, servo_id, baud)
        servo = commissioning.OneServo(line, servo_id)
        servo.require_movable(reach_deg)
        yield servo
    finally:
        line.close()


def jog(
    servo: Servo, request: JogRequest, record: JogRecord, progress: Callable[[str], None]
) -> None:
    """Move, filling a record, and end with torque off, read back.

    Raises BackendError, and what a signal means; the record then ends where the servo was let go.
    """
    places = [request.reach_deg, 0.0, -request.reach_deg, 0.0]
    clock, signals = MonotonicClock(), StopSignals()
    began_ns = clock.now_ns()

    def hold(place: float, seconds: float) -> None:
        servo.go(place)
        until_ns = clock.now_ns() + round(seconds * 1e9)
        while (now_ns := clock.now_ns()) < until_ns:
            sample = servo.look((now_ns - began_ns) * 1e-9)
            if sample is not None:
                record.samples.append(sample)
                _require_sane(servo, sample, request.reach_deg)
            signals.check()
            clock.sleep_until_ns(now_ns + PERIOD_NS)

    with signals.caught():
        try:
            servo.begin(request.effort, request.speed_dps)
            progress("slowly")
            for place in places:
                hold(place, HOLD_S + request.reach_deg / request.speed_dps)
            if request.sharp:
                progress("in sharp steps")
                servo.profile(0.0)
                record.sharp_from = len(record.samples)
                for place in places:
                    hold(place, HOLD_S)
        finally:
            with signals.shielded():
                servo.end()


def _require_sane(servo: Servo, sample: JogSample, reach_deg: float) -> None:
    if abs(sample.position_deg) > reach_deg + STRAY_DEG:
        raise BackendError(
            f"{servo.where}: stands {sample.position_deg:+.1f}° from where it began, beyond "
            f"{reach_deg + STRAY_DEG:.0f}°: stopped"
        )


def step_figures(record: JogRecord) -> list[StepFigures]:
    """Figures of every sharp step."""
    samples, first = record.samples, record.sharp_from
    if first is None:
        return []
    goals = np.array([sample.goal_deg for sample in samples])
    changes = (np.flatnonzero(np.diff(goals)) + 1).tolist()
    bounds = [*(index for index in changes if index >= first), len(samples)]
    return [
        _figures(samples[begin:end], samples[begin - 1].position_deg, float(goals[begin - 1]))
        for begin, end in pairwise(bounds)
    ]


def _figures(part: list[JogSample], first_deg: float, from_deg: float) -> StepFigures:
    time = np.array([sample.time_s for sample in part]) - part[0].time_s
    goal = part[0].goal_deg
    way = goal - from_deg
    moved = (np.array([sample.position_deg for sample in part]) - first_deg) / way
    rest = float(np.mean([sample.position_deg for sample in part[-5:]]))

    def when(level: float) -> float | None:
        there = np.flatnonzero(moved >= level)
        return float(1e3 * time[there[0]]) if there.size else None

    ten, ninety = when(0.1), when(0.9)
    past = max((sample.position_deg - goal) / way for sample in part)
    return StepFigures(
        from_deg=from_deg,
        to_deg=goal,
        dead_time_ms=when(_MOVED_DEG / abs(way)),
        rise_time_ms=None if ten is None or ninety is None else ninety - ten,
        overshoot_pct=100.0 * max(0.0, past),
        rest_error_deg=goal - rest,
    )
