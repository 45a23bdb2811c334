"""The supervisor of one run: asks every monitor, decides, and keeps the book of faults."""

from collections.abc import Iterable

from hil.safety.body import BodyMonitor
from hil.safety.decision import RUNNING, Action, SafetyState, WayOut, decide
from hil.safety.monitor import Monitor, Situation
from hil.safety.severity import Event, Fault, Severity


class Supervisor:
    """Judges every tick before its command is made. Raises nothing and sends nothing."""

    def __init__(
        self, monitors: Iterable[Monitor], way_out: WayOut, *, leaps: bool = False
    ) -> None:
        """`leaps`: the robot jumps, and what that asks of the body is no fall."""
        self.state: SafetyState = RUNNING
        self.faults: list[Fault] = []
        """What went wrong so far, in order."""
        self._body = BodyMonitor(predicts=way_out.land_ns > 0, leaps=leaps)
        self._monitors = (self._body, *monitors)
        self._way_out = way_out
        self._pending: list[Event] = []
        self._told: set[tuple[str, str, str]] = set()

    def begin_walking(self, base_height: float) -> None:
        """T = 0, with the root body at a height [m]."""
        self._body.begin_walking(base_height)

    def note(self, event: Event) -> None:
        """An event that no monitor sees: a signal, an exception, a command that is not sound."""
        self._pending.append(event)

    def finish(self, now_ns: int) -> None:
        """The walk is over: sit down, then torque off. No fault."""
        if self.state.severity == Severity.OK:
            self.state = SafetyState(Severity.SOFT_STOP, now_ns)
            self._body.begin_sitting()

    def judge(self, situation: Situation, time_s: float) -> Action:
        """What to do in this tick; `time_s` from T = 0, for the book."""
        events = self._pending
        self._pending = []
        for monitor in self._monitors:
            found = monitor.look(situation)
            if found:
                events = [*events, *found]
        before = self.state
        self.state, action = decide(situation.now_ns, before, events, self._way_out)
        if self.state.severity > before.severity and self.state.severity >= Severity.SOFT_STOP:
            self._body.begin_sitting()
        if events:
            self._write_down(events, time_s)
        return action

    def _write_down(self, events: list[Event], time_s: float) -> None:
        """Each trouble once a run, and once more when it gets worse: a link that is poor for long
        is one line, not hundreds."""
        for event in events:
            told = event.severity < Severity.SOFT_STOP
            reaction = "none" if told else event.severity.name.lower()
            key = event.source, event.name, reaction
            if key not in self._told:
                self._told.add(key)
                self.faults.append(Fault(time_s, event.source, event.name, reaction))
