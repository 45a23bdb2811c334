"""The hot path of one servo bus: one group read and one write a tick.

The answer of a fast read is checked with one CRC and decoded as one numpy block; only when
something is wrong is it taken apart servo by servo. Nothing here waits: `BusGroup` does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.chain import Chain
from drivers.dynamixel.port import Port
from drivers.dynamixel.protocol import FastBlock, PacketReader, crc16, decode_fast_status
from drivers.dynamixel.read_plan import (
    FAULT,
    HOT,
    HOT_DTYPE,
    SLOW,
    Block,
    BusServo,
    ReadPlan,
    plan_read,
)
from drivers.dynamixel.state_filler import StateFiller
from drivers.dynamixel.states import ServoStates
from drivers.dynamixel.write_plan import ServoWriter
from hil.servo import ServoGoals

POLL_EVERY = 10
"""Ticks between longer reads; each takes one servo, in turn."""
LEAST_MARGIN_NS = 300_000
"""Waiting beyond wire, turnaround and adapter: USB jitter and the host's wake-up (assumed)."""
FAST_TRIALS = 10
"""Fast reads without any answer after which plain ones are used, if fast ones never worked."""
_FAST_START = 8


@dataclass(slots=True)
class BusCounters:
    """What went wrong on a bus since it was opened."""

    crc_errors: int = 0
    timeouts: int = 0
    """Reads that ran into their deadline."""
    late: int = 0
    """Answers to the request of an earlier tick; those of the last one are taken, at their age."""
    stale: int = 0
    """Servo samples that did not arrive in their tick."""


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
        margin_ns: int = LEAST_MARGIN_NS,
    ) -> None:
        """`margin_ns` is how long to wait beyond the time that an answer should take."""
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
        self._plans: dict[tuple[tuple[int, ...], Block, bool], ReadPlan] = {}
        self._plan: ReadPlan | None = None
        self._late_plan: ReadPlan | None = None
        self._late_sample_ns = self._sample_ns = 0
        self._buffer = b""
        self._reader = PacketReader()
        self._turn = self._damaged = 0
        self._tick = self._polled = 0
        self._fast_failures: int | None = 0
        joints = np.array([servo.joint for servo in servos], dtype=np.int64)
        self._writer = ServoWriter([servo.id for servo in servos], joints)

    def begin_read(self, now_ns: int) -> None:
        """Send this tick's request."""
        members = self._chain.members()
        self._expect_late()
        self._plan = None
        self._turn = self._damaged = 0
        if not members:
            return
        plan = self._plan = self._choose(members)
        self._reader.reset()
        self.port.write(plan.packet)
        self.deadline_ns = now_ns + plan.timeout_ns
        self._sample_ns = now_ns + plan.sample_delay_ns
        self._filler.begin(self._sample_ns)

    def _expect_late(self) -> None:
        """A fast answer of which nothing could be used may still come; else start afresh."""
        plan = self._plan
        if plan is not None and plan.fast and not self._filler.heard:
            self._late_plan, self._late_sample_ns = plan, self._sample_ns
            self._buffer = self._buffer[-plan.reply_size :]
            return
        self._late_plan = None
        self._buffer = b""
        self.port.discard_input()

    def collect(self) -> bool:
        """Take what was received; True when nothing more is to come."""
        plan = self._plan
        if plan is None:
            return True
        data = self.port.read_available()
        if not plan.fast:
            return self._collect_plain(plan, data)
        self._buffer += data
        if self._late_plan is not None:
            self._take_late(self._late_plan)
        while len(self._buffer) >= plan.reply_size:
            start = self._buffer.find(plan.start)
            end = start + plan.reply_size
            if start < 0 or len(self._buffer) < end:
                return False
            if self._take_whole(plan, self._buffer[start:end]):
                return True
            self.counters.late += 1
            self._buffer = self._buffer[end:]
        return False

    def finish_read(self) -> None:
        """End the tick's read: save what arrived of an answer, note who did not."""
        plan = self._plan
        if plan is None:
            self.counters.stale += len(self._servos)
            return
        heard = self._filler.heard
        if plan.fast and not heard:
            self._salvage(plan)
        self.counters.stale += len(self._servos) - len(heard)
        if self._chain.silent:
            for place in heard:
                self._chain.heard(place)
        if len(heard) < len(plan.members):
            self._note_missing(plan)

    def write(self, goals: ServoGoals) -> None:
        """Send the goals of this bus's servos: positions always, the rest where it changed."""
        self.port.write(self._writer.encode(goals))

    def forget_written(self) -> None:
        """Send everything with the next write (after a reboot or arming)."""
        self._writer.forget()

    def _choose(self, members: tuple[int, ...]) -> ReadPlan:
        """The plan of this tick: in a polling tick, the servo whose turn it is goes to the end."""
        self._tick += 1
        unexplained = self._filler.unexplained()
        due = unexplained is not None or self._tick % POLL_EVERY == 0
        if not due or any(place in members for place in self._chain.silent):
            return self._plan_for(members, HOT)
        place = unexplained
        if place is None:
            self._polled += 1
            place = sorted(members)[self._polled % len(members)]
        self._writer.refresh(place)
        block = FAULT if place in self._filler.alerting else SLOW
        return self._plan_for((*(p for p in members if p != place), place), block)

    def _plan_for(self, members: tuple[int, ...], last: Block) -> ReadPlan:
        key = (members, last, self.fast)
        if key not in self._plans:
            servos = [self._servos[place] for place in members]
            self._plans[key] = plan_read(
                members, servos, last, self.fast, self._timing, self._margin_ns
            )
        return self._plans[key]

    def _take_late(self, plan: ReadPlan) -> None:
        """Take the last tick's answer for what it is: older, and better than none."""
        start = self._buffer.find(plan.start)
        end = start + plan.reply_size
        if start < 0 or len(self._buffer) < end:
            return
        self._filler.begin(self._late_sample_ns)
        if self._take_whole(plan, self._buffer[start:end]) and self._filler.heard:
            self.counters.late += 1
            self._buffer = self._buffer[end:]
            for place in self._filler.heard:
                self._chain.heard(place)
        self._late_plan = None
        self._filler.begin(self._sample_ns)

    def _take_whole(self, plan: ReadPlan, raw: bytes) -> bool:
        """Decode a fast answer that is as long as it should be; False if it is an earlier one.

        One that is damaged or carries alerts is left to `finish_read`.
        """
        if crc16(raw[:-2]) != raw[-2] | raw[-1] << 8:
            return True
        count = len(plan.ids) if plan.last is HOT else len(plan.ids) - 1
        blocks = np.frombuffer(raw, HOT_DTYPE, count, _FAST_START)
        if blocks["id"].tobytes() != plan.id_bytes[:count]:
            return False
        if self._filler.alerting or blocks["error"].any():
            return True
        self._filler.take_all(plan, blocks)
        if plan.last is not HOT:
            tail = raw[-(plan.last.length + 4) : -2]
            self._filler.take(plan, FastBlock(tail[0], tail[1], tail[2:]))
        self._fast_failures = None
        return True

    def _collect_plain(self, plan: ReadPlan, data: bytes) -> bool:
        """Take the status packets of a plain read, in the order of the chain."""
        errors = self._reader.crc_errors
        packets = self._reader.feed(data)
        self._damaged += self._reader.crc_errors - errors
        self.counters.crc_errors += self._reader.crc_errors - errors
        for packet in packets:
            if not packet.is_status or packet.id not in plan.ids:
                continue
            turn = plan.ids.index(packet.id)
            # The first of the chain begins anew: what came before it was a late answer.
            if turn == 0 or self._turn <= turn <= self._turn + self._damaged:
                self._filler.take(plan, FastBlock(packet.error, packet.id, packet.data))
                self._turn = turn + 1
            else:
                self.counters.late += 1
        return self._turn == len(plan.ids)

    def _salvage(self, plan: ReadPlan) -> None:
        """Take the blocks of a fast answer that can be trusted."""
        start = max(0, self._buffer.find(plan.start))
        blocks = decode_fast_status(self._buffer[start:], plan.lengths)
        for block, servo_id in zip(blocks, plan.ids, strict=False):
            if block.id == servo_id:
                self._filler.take(plan, block)
        if blocks:
            self._fast_failures = None
        elif self._fast_failures is not None:
            self._fast_failures += 1
            self.fast = self._fast_failures < FAST_TRIALS

    def _note_missing(self, plan: ReadPlan) -> None:
        """Count the failure; if it was silence, blame the first servo that did not answer."""
        if plan.fast and len(self._buffer) >= plan.reply_size:
            self.counters.crc_errors += 1
            return
        heard = self._filler.heard
        self.counters.timeouts += 1
        self._chain.missed(next(place for place in plan.members if place not in heard))
