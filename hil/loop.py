"""The control loop: start-up, walking ticks, one way out.

Whatever ends a run (its time, a fall, a lost servo, an exception of any part, a signal), the
robot is stopped softly, its torque is switched off and read back, and its session is closed.
"""

from dataclasses import dataclass, field

from hil.cycle import Cycle, Sink
from hil.errors import StrideError
from hil.interface import Estimate, JointCommand, Reference
from hil.safety import Fault
from hil.session import Session
from hil.shutdown import stop_and_close
from hil.signals import StopSignals
from hil.startup import stand_up
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
        """Whether the body fell."""
        return any(fault.name == "fell" for fault in self.faults)


class Loop:
    """Runs one session whose backend is open, and closes the session."""

    def __init__(self, session: Session, sinks: tuple[Sink, ...]) -> None:
        self.outcome = Outcome()
        self._session = session
        self._signals = StopSignals()
        rate_hz = session.request.rate_hz or session.description.defaults.rate_hz
        self._cycle = Cycle(session, rate_hz, sinks)

    def run(self) -> Outcome:
        """Walk for the requested time; raises what any part raised, once the robot is safe."""
        with self._signals.caught():
            try:
                self._run_to_the_end()
            except BaseException as error:
                self._note(error)
                self._make_safe_after(error)
                raise
            with self._signals.shielded():
                stop_and_close(self._session)
        return self.outcome

    def _run_to_the_end(self) -> None:
        with real_time_priority(self._session.request.priority), quiet_garbage_collector():
            fault = self._start()
            if fault is None:
                fault = self._walk()
        if fault is not None:
            self.outcome.faults.append(fault)

    def _start(self) -> Fault | None:
        if self._session.description.start.moving:
            self._session.backend.arm()
            self._cycle.begin(0)
            return None
        return stand_up(self._session, self._cycle, self._signals.check)

    def _walk(self) -> Fault | None:
        cycle, clock = self._cycle, self._session.backend.clock
        ticks = round(self._session.request.duration_s * cycle.rate_hz)
        clock_start, wall_start = clock.now_ns(), stopwatch_ns()
        missed_before = cycle.schedule.missed
        source = self._first_step
        fault = None
        try:
            while fault is None and cycle.schedule.next_tick < ticks:
                fault = cycle.tick(source)
                source = self._session.controller.step
                self._signals.check()
        finally:
            self.outcome.clock_ns = clock.now_ns() - clock_start
            self.outcome.wall_ns = stopwatch_ns() - wall_start
            self.outcome.missed = cycle.schedule.missed - missed_before
        return fault

    def _first_step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The controller's first step, at which the body stands as high as it should."""
        self._cycle.supervisor.begin_walking(self._cycle.base_height(estimate))
        return self._session.controller.step(estimate, reference)

    def _note(self, error: BaseException) -> None:
        time_s = self._cycle.schedule.tick / self._cycle.rate_hz
        source = "program" if isinstance(error, Exception) else "operator"
        fault = Fault(time_s, source, type(error).__name__, "torque_off")
        self.outcome.faults.append(fault)

    def _make_safe_after(self, error: BaseException) -> None:
        """Stop and close; a second error is noted on the first one and does not replace it."""
        try:
            with self._signals.shielded():
                stop_and_close(self._session)
        except Exception as second:
            error.add_note(str(second) if isinstance(second, StrideError) else repr(second))
