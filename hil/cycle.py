"""One tick: read, estimate, judge, control, limit, write, hand over."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hil.interface import (
    AppliedCommand,
    Estimate,
    JointCommand,
    Reference,
    SensorFrame,
    Truth,
    WalkStatus,
)
from hil.limits import JointLimits
from hil.safety import Fault, Supervisor
from hil.schedule import Operator
from hil.session import Session
from hil.timing import TickSchedule, TickTiming, stopwatch_ns

CommandSource = Callable[[Estimate, Reference], JointCommand]


@dataclass(slots=True)
class TickRecord:
    """Everything of one tick. The parts are reused by the next one: copy what you keep."""

    time_ns: int
    """Clock time at which the tick was due."""
    time_s: float
    """The same, counted from the first walking tick; negative during start-up."""
    command: JointCommand
    """What was asked for, before the limits."""
    applied: AppliedCommand
    frame: SensorFrame
    estimate: Estimate
    reference: Reference
    status: WalkStatus
    truth: Truth | None
    timing: TickTiming


class Sink(Protocol):
    """Where the record of every tick goes."""

    def put(self, record: TickRecord) -> None:
        """Take what is needed, at once: the tick waits."""
        ...


class Cycle:
    """Runs the ticks of one session. `session.request` must be resolved."""

    def __init__(self, session: Session, rate_hz: int, sinks: tuple[Sink, ...]) -> None:
        description, n = session.description, len(session.description.joints)
        self.rate_hz = rate_hz
        self.supervisor = Supervisor(description)
        self.schedule = TickSchedule(session.backend.clock, rate_hz)
        self._session = session
        self._sinks = sinks
        self._operator = Operator(session.request.schedules, description.defaults.speed)
        self._limits = JointLimits(description)
        self._pushing = False
        self._timing = TickTiming()
        self._truth: Truth | None = None
        self._hand_over_ns = 0
        self._command, self._applied = JointCommand.zeros(n), AppliedCommand.zeros(n)

    def begin(self, first_tick: int) -> None:
        """The next tick is this one, now."""
        self.schedule = TickSchedule(self._session.backend.clock, self.rate_hz, first_tick)

    def tick(self, source: CommandSource) -> Fault | None:
        """One tick with commands from a source; the fault that forbids the next one, or none.

        The judge sees the truth of the end of the tick before: a simulated world in another
        process is asked after the write, where nobody waits for it.
        """
        session, timing = self._session, self._timing
        timing.tick = tick = self.schedule.wait()
        timing.late_ns = self.schedule.late_ns
        time_s = tick / self.rate_hz
        started = stopwatch_ns()
        self._push(time_s)
        self._throw(time_s)
        frame = session.backend.read()
        read = stopwatch_ns()
        estimate = session.estimator.update(frame)
        estimated = controlled = stopwatch_ns()
        reference = self._operator.reference(time_s)
        fault = self.supervisor.judge(time_s, frame, self._truth or estimate)
        if fault is None:
            self._command = source(estimate, reference)
            controlled = stopwatch_ns()
            self._applied = session.backend.write(self._limits.apply(self._command))
            self._applied.limit |= self._limits.flags
        written = stopwatch_ns()
        timing.read_ns, timing.estimate_ns = read - started, estimated - read
        timing.control_ns, timing.write_ns = controlled - estimated, written - controlled
        self._hand_over(time_s, frame, estimate, reference, started)
        self.schedule.finish()
        return fault

    def base_height(self, estimate: Estimate) -> float:
        """Height of the root body [m], from the truth where it is known."""
        return float((self._truth or estimate).base_position[2])

    def _push(self, time_s: float) -> None:
        world = self._session.world
        if world is None or not self._session.request.schedules.pushes:
            return
        force = self._operator.push(time_s)
        pushing = bool(np.any(force))
        if pushing or self._pushing:
            world.set_push(force)
        self._pushing = pushing

    def _throw(self, time_s: float) -> None:
        world = self._session.world
        if world is None or not self._session.request.schedules.balls:
            return
        ball = self._operator.ball(time_s)
        if ball is not None:
            world.throw_ball(ball.mass, np.array(ball.velocity))

    def _hand_over(
        self,
        time_s: float,
        frame: SensorFrame,
        estimate: Estimate,
        reference: Reference,
        started: int,
    ) -> None:
        session, timing = self._session, self._timing
        asked = stopwatch_ns()
        if session.world is not None:
            self._truth = session.world.truth()
        timing.truth_ns = stopwatch_ns() - asked
        record = TickRecord(
            self.schedule.time_ns(timing.tick),
            time_s,
            self._command,
            self._applied,
            frame,
            estimate,
            reference,
            session.controller.status,
            self._truth,
            timing,
        )
        handing_over = stopwatch_ns()
        timing.cycle_ns = handing_over - started + self._hand_over_ns
        for sink in self._sinks:
            sink.put(record)
        self._hand_over_ns = stopwatch_ns() - handing_over
