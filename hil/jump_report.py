"""The report keys of a jump, from its trace and its plan."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from hil.interface import GRAVITY, Bools, Floats
from hil.trace import Trace

STILL = 0.1
"""Speed of the centre of mass below which a robot counts as standing, in √(g·h)."""
TOUCHING = 0.01
"""Share of the mean load that is a contact."""
KEYS = (
    "landing_error_m",
    "apex_error_m",
    "takeoff_velocity_error_mps",
    "airtime_s",
    "foot_clearance_m",
    "peak_joint_torque_ratio",
    "landed_standing",
)


class PlannedPath(Protocol):
    """The part of a planned path that a report compares."""

    @property
    def take_off_velocity(self) -> Floats:
        """[m/s], (3,)."""
        ...

    @property
    def apex(self) -> Floats:
        """Highest point of the centre of mass [m], (3,)."""
        ...

    @property
    def duration(self) -> float:
        """Push and flight together [s]."""
        ...

    def position(self, time: Floats) -> Floats:
        """Centre of mass [m], (k, 3), at k times from the begin of the push [s]."""
        ...


class Plan(Protocol):
    """The part of a jump's plan that a report compares."""

    @property
    def feet(self) -> Floats:
        """Centre of the soles at the start [m], (3,)."""
        ...

    @property
    def landing_feet(self) -> Floats:
        """Where it shall be in the end [m], (3,)."""
        ...

    @property
    def path(self) -> PlannedPath:
        """From the begin of the push."""
        ...


@dataclass(frozen=True, slots=True)
class JumpReview:
    """What is known of a jump once it is over, beside its trace."""

    plan: Callable[[], Plan | None]
    """None if it ended before its first step."""
    soles: Callable[[Trace, int], Floats]
    """Corners of the soles at a tick of a trace [m], (2, 4, 3)."""
    torque_ratio: Callable[[], float]
    """Largest torque asked for, as a share of its joint's limit."""
    span: Callable[[], tuple[int, int | None]] = lambda: (0, None)
    """Tick of the run with which the jump begins, and the one after its end, if a walk goes on."""

    def of(self, trace: Trace) -> Trace:
        """The jump's part of the trace of a run; nothing if the run ended before it."""
        return trace.part(*self.span())

    def figures(self, trace: Trace, fell: bool) -> dict[str, Any]:
        """The report keys."""
        return jump_figures(self.of(trace), self.plan(), self.soles, self.torque_ratio(), fell)


def foot_loads(trace: Trace) -> Floats:
    """What each foot carries [N], (T, 2)."""
    loads: Floats = trace.foot_force.sum(axis=2) + trace.toe_force
    return loads


def airborne(trace: Trace) -> Bools:
    """Ticks in which no foot bears anything, (T,)."""
    load = foot_loads(trace).sum(axis=1)
    return np.asarray(load < TOUCHING * load.mean())


def flight_of(trace: Trace) -> tuple[int, int] | None:
    """First tick in the air and first one after it, of the longest flight; None without one."""
    in_the_air = np.concatenate(([False], airborne(trace), [False]))
    edges = np.flatnonzero(np.diff(in_the_air.astype(np.int8)))
    begins, ends = edges[::2], edges[1::2]
    if not begins.size:
        return None
    longest = int(np.argmax(ends - begins))
    return int(begins[longest]), int(ends[longest])


def jump_figures(
    trace: Trace,
    plan: Plan | None,
    soles: Callable[[Trace, int], Floats],
    torque_ratio: float,
    fell: bool,
) -> dict[str, Any]:
    """Landing error at the end of the trace, horizontal; apex, take-off and airtime of the flight.

    Errors are measured minus planned; the apex signed, the others as a distance. The clearance is
    how high the lowest corner of both feet comes. A jump that never left the ground has an airtime
    and a clearance of 0, and no errors. `soles` gives their corners at a tick [m], (2, 4, 3).
    """
    figures: dict[str, Any] = dict.fromkeys(KEYS)
    figures["peak_joint_torque_ratio"] = torque_ratio
    figures["landed_standing"] = False
    figures["airtime_s"] = figures["foot_clearance_m"] = 0.0
    flight = None if plan is None else flight_of(trace)
    if plan is None or flight is None:
        return figures
    begin, end = flight
    in_the_air = [soles(trace, tick) for tick in range(max(begin - 1, 0), end)]
    lowest = [float(corners[..., 2].min()) for corners in in_the_air]
    figures["foot_clearance_m"] = max(lowest) - lowest[0]
    moved = soles(trace, -1).mean(axis=(0, 1)) - in_the_air[0].mean(axis=(0, 1))
    wanted = plan.landing_feet - plan.feet
    figures["landing_error_m"] = float(np.hypot(*(moved - wanted)[:2]))
    figures["apex_error_m"] = float(trace.com[begin:end, 2].max() - plan.path.apex[2])
    missed = trace.com_velocity[begin] - plan.path.take_off_velocity
    figures["takeoff_velocity_error_mps"] = float(np.linalg.norm(missed))
    period = float(np.mean(np.diff(trace.time_s)))
    figures["airtime_s"] = (end - begin) * period
    speed = float(np.linalg.norm(trace.com_velocity[-1]))
    still = speed < STILL * float(np.sqrt(GRAVITY * trace.com[0, 2]))
    both = bool((trace.foot_force[-1].sum(axis=1) > 0.0).all())
    figures["landed_standing"] = both and still and not fell
    return figures
