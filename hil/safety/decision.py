"""The decision of a tick: pure, so that every state and every event can be tried.

Ways: RUN → SIT → OFF; RUN, SIT → LAND → OFF; any → OFF. Nothing leads back from SIT, LAND or OFF:
only a new start, with every check before arming, moves the robot again.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from hil.safety.severity import Event, Severity


class Action(Enum):
    """What the loop does in a tick."""

    RUN = "run"
    SIT = "sit"
    LAND = "land"
    OFF = "torque_off"


@dataclass(frozen=True, slots=True)
class SafetyState:
    """What is remembered from tick to tick."""

    severity: Severity = Severity.OK
    """OK, or the latched severity."""
    since_ns: int = 0
    """When it was latched [ns]."""


@dataclass(frozen=True, slots=True)
class WayOut:
    """How long the ways out take [ns]; 0 goes straight to OFF."""

    sit_ns: int
    land_ns: int


RUNNING = SafetyState()


def decide(
    now_ns: int, state: SafetyState, events: Sequence[Event], way_out: WayOut
) -> tuple[SafetyState, Action]:
    """The state after this tick and what to do in it.

    The most severe event wins. From SOFT_STOP on a severity is latched and only rises; SIT and
    LAND end in OFF when their time is over, and nothing that comes later moves the robot again.
    """
    action = _action(now_ns, state, way_out)
    if action is Action.OFF:
        return state, action
    worst = max(events, key=lambda event: event.severity, default=None)
    if worst is not None and worst.severity > max(state.severity, Severity.WARN):
        state = SafetyState(worst.severity, now_ns)
    return state, _action(now_ns, state, way_out)


def _action(now_ns: int, state: SafetyState, way_out: WayOut) -> Action:
    elapsed_ns = now_ns - state.since_ns
    if state.severity == Severity.OK:
        return Action.RUN
    if state.severity == Severity.SOFT_STOP and elapsed_ns < way_out.sit_ns:
        return Action.SIT
    if state.severity == Severity.LAND and elapsed_ns < way_out.land_ns:
        return Action.LAND
    return Action.OFF
