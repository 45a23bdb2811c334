"""The control loop: start-up, walking ticks, one way out.

Whatever ends a run (its time, a fall, a lost servo, an exception of any part, a signal), the
robot sits down or lies already, its torque is switched off and read back, its session closed.
"""

from contextlib import nullcontext
from dataclasses import dataclass, field

from hil.cycle import Cycle, Sink
from hil.errors import StrideError
from hil.interface import Estimate, JointCommand, Reference
from hil.pacer import Pacer
from hil.safety.decision import Action
from hil.safety.severity import Event, Fault, Severity
from hil.session import Session
from hil.shutdown import stop_and_close
from hil.signals import OperatorStop, StopSignals
from hil.startup import stand_up
from hil.steering.helm import Helm
from hil.stop_listener import StopListener
from hil.timing import quiet_garbage_collector, real_time_priority, stopwatch_ns


@dataclass(slots=True)
class Outcome:
    """How a run went, as far as the loop can tell."""

    faults: list[Fault] = field(default_factory=list)
    clock_ns: int = 0
    """Walking time on the backend's clock."""
    wall_ns: int = 0
    """Walking time on the wall clock."""
    missed: int = 0
    """Deadlines missed while walking."""

    @property
    def fell(self) -> bool:
        """Whether the body fell, or was falling when the run ended."""
        return any(fault.name in ("fell", "falling") for fault in self.faults)


class Loop:
    """Runs one session whose backend is open, and closes the session."""

    def __init__(
        self,
        session: Session,
        sinks: tuple[Sink, ...],
        *,
        sits: bool = True,
        listener: StopListener | None = None,
        helm: Helm | None = None,
        pacer: Pacer | None = None,
    ) -> None:
        """`sits`: sit down when the walk is over; a study may save the time. `listener`: where
        the operator is heard beside signals. `helm`: what steers; a walk then waits for its word.
        `pacer`: holds back virtual time.
        """
        self.outcome = Outcome()
        self._session, self._sits = session, sits
        self._listener, self._helm, self._pacer = listener, helm, pacer
        self._at_rest = False
        self._signals = StopSignals()
        rate_hz = session.request.rate_hz or session.description.defaults.rate_hz
        self._cycle = Cycle(session, rate_hz, sinks, helm)

    def run(self) -> Outcome:
        """Walk for the requested time; raises what any part raised, once the robot is safe."""
        listener = self._listener
        hearing = nullcontext() if listener is None else listener.listening(self._signals.post)
        with self._signals.caught(), hearing:
            try:
                self._run_to_the_end()
            except BaseException as error:
                if not self._at_rest:
                    self._note(error)
                self._make_safe_after(error)
                raise
            with self._signals.shielded():
                stop_and_close(self._session)
        return self.outcome

    def _run_to_the_end(self) -> None:
        self.outcome.faults = self._cycle.supervisor.faults
        with real_time_priority(self._session.request.priority), quiet_garbage_collector():
            action = self._start()
            if action is Action.RUN:
                action = self._walk()
            if action is not Action.OFF:
                self._rest()
        self._at_rest = True
        if self._cycle.error is not None:
            raise self._cycle.error
        self._signals.check()

    def _start(self) -> Action:
        if self._session.description.start.moving:
            self._session.backend.arm()
            self._cycle.begin(0)
            return Action.RUN
        helm = self._helm
        waits = helm is not None and self._session.request.activity == "walk"
        begun = (lambda: helm is None or helm.started) if waits else None
        return stand_up(self._session, self._cycle, self._signals.check, self._listen, begun)

    def _walk(self) -> Action:
        cycle, clock = self._cycle, self._session.backend.clock
        ticks = round(self._session.request.duration_s * cycle.rate_hz)
        clock_start, wall_start = clock.now_ns(), stopwatch_ns()
        missed_before = cycle.schedule.missed
        source = self._first_step
        action = Action.RUN
        if self._session.begin_faults is not None:
            self._session.begin_faults(cycle.schedule.time_ns(0))
        try:
            while action is Action.RUN and cycle.schedule.next_tick < ticks:
                action = cycle.tick(source)
                source = self._session.controller.step
                self._listen()
        finally:
            self.outcome.clock_ns = clock.now_ns() - clock_start
            self.outcome.wall_ns = stopwatch_ns() - wall_start
            self.outcome.missed = cycle.schedule.missed - missed_before
        return action

    def _rest(self) -> None:
        """The way down, if it has begun, or as the walk's own end."""
        supervisor = self._cycle.supervisor
        if supervisor.state.severity == Severity.OK:
            if not self._sits:
                return
            supervisor.finish(self._session.backend.clock.now_ns())
        while self._cycle.tick(self._session.controller.step) is not Action.OFF:
            self._listen()

    def _listen(self) -> None:
        """Hand what the operator asks for, or another problem, to the supervisor."""
        supervisor, watch = self._cycle.supervisor, self._session.watch
        if self._pacer is not None:
            schedule = self._cycle.schedule
            self._pacer.wait(schedule.time_ns(schedule.tick))
        while (request := self._signals.news()) is not None:
            severity = Severity.TORQUE_OFF if request.now else Severity.SOFT_STOP
            supervisor.note(Event("operator", request.name, severity))
        problem = watch() if watch is not None else None
        if problem is not None:
            supervisor.note(Event("program", problem, Severity.SOFT_STOP))

    def _first_step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The controller's first step, at which the body stands as high as it should."""
        self._cycle.begin_walking(estimate)
        return self._session.controller.step(estimate, reference)

    def _note(self, error: BaseException) -> None:
        time_s = self._cycle.schedule.tick / self._cycle.rate_hz
        source = "program" if isinstance(error, Exception) else "operator"
        name = str(error) if isinstance(error, OperatorStop) else type(error).__name__
        fault = Fault(time_s, source, name, "torque_off")
        self.outcome.faults.append(fault)

    def _make_safe_after(self, error: BaseException) -> None:
        """Stop and close; a second error is noted on the first one and does not replace it."""
        try:
            with self._signals.shielded():
                stop_and_close(self._session)
        except Exception as second:
            error.add_note(str(second) if isinstance(second, StrideError) else repr(second))
