"""One tick: read, estimate, judge, control, limit, write, hand over."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hil.errors import InvalidCommandError
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
from hil.robot_facts import body_weight
from hil.safety.assembly import make_supervisor
from hil.safety.decision import Action
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity
from hil.safety.way_out import WayDown
from hil.schedule import Medium, Operator
from hil.session import Session
from hil.steering.helm import Helm
from hil.timing import TickSchedule, TickTiming, stopwatch_ns

NO_TICK = -(1 << 60)
CommandSource = Callable[[Estimate, Reference], JointCommand]


@dataclass(slots=True)
class SafetyStatus:
    """What the supervisor decided in a tick, for recordings."""

    severity: int = 0
    """Latched `Severity`."""
    walking: bool = False
    """From T = 0 until the way down begins."""


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
    safety: SafetyStatus
    truth: Truth | None
    timing: TickTiming


class Sink(Protocol):
    """Where the record of every tick goes."""

    def put(self, record: TickRecord) -> None:
        """Take what is needed, at once: the tick waits."""
        ...


class Cycle:
    """Runs the ticks of one session. `session.request` must be resolved."""

    def __init__(
        self,
        session: Session,
        rate_hz: int,
        sinks: tuple[Sink, ...],
        helm: Helm | None = None,
    ) -> None:
        description, n = session.description, len(session.description.joints)
        self.rate_hz = rate_hz
        weight_n = body_weight(description) if description.actuation == "servo" else 0.0
        paced = not session.request.lockstep
        self.supervisor = make_supervisor(
            description, rate_hz, weight_n, paced=paced, feet=session.request.feet
        )
        self.error: Exception | None = None
        """What the command source raised first; the robot sits down before it comes out."""
        self.schedule = TickSchedule(session.backend.clock, rate_hz)
        self._session = session
        self._sinks = sinks
        self._helm = helm
        self._operator = Operator(session.request.schedules, description.defaults.speed)
        goals = description.actuation == "servo"
        self._limits = JointLimits(description, rate_hz if goals else None)
        self._way_down = WayDown(description, rate_hz)
        self._pushing = False
        self._medium: Medium | None = None
        self._timing = TickTiming()
        self._truth: Truth | None = None
        self._hand_over_ns = 0
        self._command, self._applied = JointCommand.zeros(n), AppliedCommand.zeros(n)
        self._rejected = NO_TICK
        self._situation: Situation | None = None
        self._safety = SafetyStatus()

    def begin(self, first_tick: int) -> None:
        """The next tick is this one, now."""
        self.schedule = TickSchedule(self._session.backend.clock, self.rate_hz, first_tick)

    def tick(self, source: CommandSource) -> Action:
        """One tick with commands from a source, as long as the supervisor lets it run.

        After OFF, nothing was sent and no tick may follow. The supervisor sees the truth of the
        end of the tick before: a simulated world in another process is asked after the write,
        where nobody waits for it.
        """
        session, timing = self._session, self._timing
        timing.tick = tick = self.schedule.wait()
        timing.late_ns = self.schedule.late_ns
        time_s = tick / self.rate_hz
        started = stopwatch_ns()
        if self._helm is not None and self._helm.act(self._operator, time_s):
            self.supervisor.note(Event("operator", "hand off the controls", Severity.WARN))
        self._push(time_s)
        self._throw(time_s)
        self._immerse(time_s)
        frame = session.backend.read()
        read = stopwatch_ns()
        estimate = session.estimator.update(frame)
        estimated = stopwatch_ns()
        reference = self._operator.reference(time_s)
        action = self.supervisor.judge(self._seen(frame, estimate), time_s)
        judged = stopwatch_ns()
        timing.control_ns = 0
        if action is not Action.OFF:
            limited = self._command_of(action, source, estimate, reference)
            self._applied = session.backend.write(limited)
            self._applied.limit |= self._limits.flags
        timing.read_ns, timing.estimate_ns = read - started, estimated - read
        timing.safety_ns = judged - estimated
        timing.write_ns = stopwatch_ns() - judged - timing.control_ns
        self._safety.severity = int(self.supervisor.state.severity)
        self._hand_over(time_s, frame, estimate, reference, started)
        self.schedule.finish()
        return action

    def begin_walking(self, estimate: Estimate) -> None:
        """T = 0: the body stands as high as it should."""
        self.supervisor.begin_walking(float((self._truth or estimate).base_position[2]))
        self._safety.walking = True

    def _seen(self, frame: SensorFrame, estimate: Estimate) -> Situation:
        motion = self._truth or estimate
        situation = self._situation
        if situation is None:
            situation = self._situation = Situation(0, frame, motion, self._applied)
        situation.now_ns = frame.time_ns
        situation.frame, situation.motion = frame, motion
        situation.applied = self._applied
        situation.walking = self._safety.walking
        return situation

    def _command_of(
        self, action: Action, source: CommandSource, estimate: Estimate, reference: Reference
    ) -> JointCommand:
        """The command of this tick, inside the limits.

        A source that raises, or whose command is not sound, is not asked for another way: the
        last sound command goes out again, and the supervisor hears of it before the next tick.
        """
        limits = self._limits
        if action is not Action.RUN:
            self._safety.walking = False
            self._command = self._way_down.command(action, limits.last)
            return limits.apply(self._command)
        asked = stopwatch_ns()
        try:
            self._command = source(estimate, reference)
            self._timing.control_ns = stopwatch_ns() - asked
            return limits.apply(self._command)
        except Exception as error:  # whatever it is, the robot sits down first
            self._note(error)
        return limits.last

    def _note(self, error: Exception) -> None:
        """One command that is not sound is passed over; anything else ends the run."""
        severity = Severity.SOFT_STOP
        if isinstance(error, InvalidCommandError) and self._rejected < self.schedule.tick - 1:
            severity = Severity.WARN
        else:
            self.error = self.error or error
        self._rejected = self.schedule.tick
        self.supervisor.note(Event("program", type(error).__name__, severity))

    def _push(self, time_s: float) -> None:
        world = self._session.world
        if world is None or not self._operator.pushes:
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

    def _immerse(self, time_s: float) -> None:
        """Set the liquid, where there is one, when it is not what it was."""
        world = self._session.world
        if world is None or not self._session.request.schedules.water:
            return
        medium = self._operator.medium(time_s)
        if medium != self._medium:
            world.set_medium(*medium)
            self._medium = medium

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
            self._safety,
            self._truth,
            timing,
        )
        handing_over = stopwatch_ns()
        timing.cycle_ns = handing_over - started + self._hand_over_ns
        for sink in self._sinks:
            sink.put(record)
        self._hand_over_ns = stopwatch_ns() - handing_over
