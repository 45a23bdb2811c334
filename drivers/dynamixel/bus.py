"""The hot path of one servo bus: one group read, one write and one idle read a tick.

Nothing here waits: `BusGroup` does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.chain import Chain
from drivers.dynamixel.fast_answer import FastAnswer
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.plain_answer import PlainAnswer
from drivers.dynamixel.port import Port
from drivers.dynamixel.read_plan import BusServo, ReadPlan, plan_read
from drivers.dynamixel.state_filler import StateFiller
from drivers.dynamixel.states import ServoStates
from drivers.dynamixel.write_plan import ServoWriter
from hil.servo import ServoGoals

POLL_EVERY = 8
"""Ticks between idle reads; each asks one servo, in turn."""
LEAST_MARGIN_NS = 300_000
"""Waiting beyond wire, turnaround and adapter: USB jitter and the host's wake-up (assumed)."""
MOST_PLANS = 100
"""Plans that are kept; more orders than that come only where many servos fail."""
FAST_TRIALS = 10
"""Fast reads without any answer after which plain ones are used, if fast ones never worked."""


@dataclass(slots=True)
class BusCounters:
    """What went wrong on a bus since it was opened."""

    crc_errors: int = 0
    timeouts: int = 0
    """Reads that ran into their deadline."""
    late: int = 0
    """Answers to the request of an earlier tick; those of the last one are taken, at their age."""
    stale: int = 0
    """Servo samples that did not arrive in their tick, or were not newer than those before."""


class ServoBus:
    """One bus. A tick is `begin_read`, `collect` until it returns True or the deadline has come,
    `finish_read`, then `write`."""

    def __init__(
        self,
        name: str,
        port: Port,
        timing: BusTiming,
        servos: Sequence[BusServo],
        states: ServoStates,
        fast: bool,
        idle: IdleReader,
        margin_ns: int = LEAST_MARGIN_NS,
    ) -> None:
        """`idle` asks in idle time; `margin_ns`: how long to wait beyond the time that an
        answer should take."""
        self.name = name
        self.port = port
        self.fast = fast
        """Whether fast reads are used."""
        self.counters = BusCounters()
        self.deadline_ns = 0
        """When waiting for the answer of this tick ends."""
        self._timing = timing
        self._servos = tuple(servos)
        self._margin_ns = margin_ns
        self._chain = Chain(len(servos))
        self._filler = StateFiller(servos, states)
        self._fast_answer = FastAnswer(self._filler)
        self._plain_answer = PlainAnswer(self._filler)
        self._plans: dict[tuple[tuple[int, ...], bool], ReadPlan] = {}
        self._plan: ReadPlan | None = None
        self._tick = 0
        self._fast_failures: int | None = 0
        ids = [servo.id for servo in servos]
        self._idle = idle
        joints = np.array([servo.joint for servo in servos], dtype=np.int64)
        self._writer = ServoWriter(ids, joints)

    def begin_read(self, now_ns: int) -> None:
        """Send this tick's request."""
        left = self.port.read_available()
        if left and self._idle.waiting:
            self._look_for_idle_answer(left)
        members = self._chain.members()
        self._plan = None
        if not members:
            return
        plan = self._plan = self._plan_for(members)
        self.port.write(plan.packet)
        self.deadline_ns = now_ns + plan.timeout_ns
        sample_ns = now_ns + plan.sample_delay_ns
        if plan.fast:
            self._fast_answer.begin(plan, sample_ns, left)
        else:
            self._plain_answer.begin(plan, sample_ns)

    def collect(self) -> bool:
        """Take what was received; True when nothing more is to come."""
        plan = self._plan
        if plan is None:
            return True
        data = self.port.read_available()
        if not data:
            return False
        if self._idle.waiting:
            self._look_for_idle_answer(data)
        answer = self._fast_answer if plan.fast else self._plain_answer
        return answer.take(data)

    def finish_read(self) -> None:
        """End the tick's read: save what arrived of an answer, note who did not."""
        plan = self._plan
        if plan is None:
            self.counters.stale += len(self._servos)
            return
        heard = self._filler.heard
        answer = self._fast_answer if plan.fast else self._plain_answer
        for place in self._fast_answer.heard_late:
            self._chain.heard(place)
        if len(heard) < len(plan.members) or answer.late:
            self._finish_incomplete(plan, answer)
        if self._chain.doubts:
            for place in heard | self._filler.repeated:
                self._chain.heard(place)
        self._idle.forget()
        self.counters.stale += len(self._servos) - len(heard)
        if plan.fast and heard:
            self._fast_failures = None

    def write(self, goals: ServoGoals | None, spare_ns: int) -> None:
        """Send the goals of this bus's servos: positions always, the rest where it changed.

        Behind them, or alone, goes a read in idle time, if one is due and `spare_ns` of time are
        left until the next tick.
        """
        data = b"" if goals is None else self._writer.encode(goals)
        self._tick += 1
        if self._tick % POLL_EVERY == 0 or self._filler.suspects or self._chain.doubts:
            needed_ns = self._timing.write_time_ns(len(data)) + self._idle.duration_ns
            if needed_ns <= spare_ns:
                data += self._idle_request()
        if data:
            self.port.write(data)

    def arm(self, armed: bool) -> None:
        """Torque was switched on or off: judge the servos by it, and send everything anew."""
        self._idle.forget()
        self._filler.arm(armed)
        self._writer.forget()

    def _plan_for(self, members: tuple[int, ...]) -> ReadPlan:
        key = members, self.fast
        if key not in self._plans:
            if len(self._plans) >= MOST_PLANS:
                self._plans.clear()
            servos = [self._servos[place] for place in members]
            self._plans[key] = plan_read(members, servos, self.fast, self._timing, self._margin_ns)
        return self._plans[key]

    def _idle_request(self) -> bytes:
        """The idle read of this tick: of a servo that is suspected, lost, or whose turn it is."""
        suspects = self._filler.suspects
        if suspects:
            return self._idle.request(min(suspects))
        lost = self._chain.next_lost()
        if lost is not None:
            return self._idle.request(lost)
        return self._idle.next_request() if self._tick % POLL_EVERY == 0 else b""

    def _look_for_idle_answer(self, data: bytes) -> None:
        answer = self._idle.take(data)
        if answer is not None:
            self._filler.take_idle(answer)
            self._writer.compare(answer.place, answer.found)
            self._chain.heard(answer.place)

    def _finish_incomplete(self, plan: ReadPlan, answer: FastAnswer | PlainAnswer) -> None:
        """Save what can be saved and count what went wrong; blame the first that was silent."""
        answer.finish()
        counters = self.counters
        counters.late += answer.late
        counters.crc_errors += answer.damaged
        answered = self._filler.heard | self._filler.repeated
        missing = [place for place in plan.members if place not in answered]
        if not missing:
            return
        self._count_fast_failure(plan)
        if not (plan.fast and answer.damaged):
            counters.timeouts += 1
            self._chain.missed(missing[0], bool(answered))

    def _count_fast_failure(self, plan: ReadPlan) -> None:
        if plan.fast and self._fast_failures is not None and not self._filler.heard:
            self._fast_failures += 1
            self.fast = self._fast_failures < FAST_TRIALS
