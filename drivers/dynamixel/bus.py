"""The hot path of one servo bus: one group read and one write a tick.

The answer of a fast read is checked with one CRC and decoded as one numpy block; only when
something is wrong is it taken apart servo by servo. Nothing here waits: `BusGroup` does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.chain import Chain
from drivers.dynamixel.control_table import VOLTAGE_UNIT, Register
from drivers.dynamixel.port import Port
from drivers.dynamixel.protocol import (
    ALERT,
    ERROR_MASK,
    FastBlock,
    PacketReader,
    crc16,
    decode_fast_status,
)
from drivers.dynamixel.read_plan import (
    FAULT,
    HOT,
    HOT_DTYPE,
    SLOW,
    Block,
    ReadPlan,
    hot_values,
    plan_read,
)
from drivers.dynamixel.states import ALERT_UNKNOWN, ServoStates
from drivers.dynamixel.write_plan import ServoWriter
from hil.interface import Ints
from hil.servo import ServoGoals

POLL_EVERY = 10
"""Ticks between longer reads; each takes one servo, in turn."""
TIMEOUT_MARGIN_NS = 300_000
"""Beyond wire, turnaround and adapter: USB jitter and the host's wake-up (assumed)."""
FAST_TRIALS = 10
"""Fast reads without any answer after which plain ones are used, if fast ones never worked."""
_FAST_START = 8


@dataclass(frozen=True, slots=True)
class BusServo:
    """One servo of a bus."""

    id: int
    joint: int
    """Index in joint order."""


@dataclass(slots=True)
class BusCounters:
    """What went wrong on a bus since it was opened."""

    crc_errors: int = 0
    timeouts: int = 0
    """Reads that ran into their deadline."""
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
    ) -> None:
        self.name = name
        self.port = port
        self.timing = timing
        self.servos = tuple(servos)
        self.fast = fast
        """Whether fast reads are used."""
        self.counters = BusCounters()
        self.deadline_ns = 0
        """When waiting for the answer of this tick ends."""
        self._states = states
        self._chain = Chain(len(servos))
        self._plans: dict[tuple[tuple[int, ...], Block, bool], tuple[ReadPlan, Ints]] = {}
        self._plan: ReadPlan | None = None
        self._joints = np.zeros(0, dtype=np.int64)
        self._buffer = b""
        self._reader = PacketReader()
        self._place = {servo.id: place for place, servo in enumerate(self.servos)}
        self._heard: set[int] = set()
        self._sample_ns = 0
        self._tick = 0
        self._polled = 0
        self._alerting: set[int] = set()
        self._fast_failures: int | None = 0
        self._writer = ServoWriter(
            [servo.id for servo in self.servos],
            np.array([servo.joint for servo in self.servos], dtype=np.int64),
        )

    # Reading

    def begin_read(self, now_ns: int) -> None:
        """Send this tick's request."""
        members = self._chain.members()
        self._plan = None
        self._buffer = b""
        self._heard.clear()
        if not members:
            return
        members, last = self._choose_last(members)
        self._plan, self._joints = self._plan_for(members, last)
        self.port.discard_input()
        self._reader.reset()
        self.port.write(self._plan.packet)
        self.deadline_ns = now_ns + self._plan.timeout_ns
        self._sample_ns = now_ns + self._plan.sample_delay_ns

    def collect(self) -> bool:
        """Take what was received; True when nothing more is to come."""
        plan = self._plan
        if plan is None:
            return True
        data = self.port.read_available()
        if not plan.fast:
            return self._collect_plain(plan, data)
        self._buffer += data
        if len(self._buffer) < plan.reply_size:
            return False
        start = self._buffer.find(plan.start)
        if start < 0 or len(self._buffer) < start + plan.reply_size:
            return False
        return self._take_whole(plan, self._buffer[start : start + plan.reply_size])

    def finish_read(self) -> None:
        """End the tick's read: save what arrived of an answer, note who did not."""
        plan = self._plan
        if plan is None:
            self.counters.stale += len(self.servos)
            return
        missing = len(self.servos) - len(self._heard)
        if not missing:
            return
        if plan.fast and not self._heard:
            self._salvage(plan)
            missing = len(self.servos) - len(self._heard)
        self.counters.stale += missing
        self._note_missing(plan)

    def _choose_last(self, members: tuple[int, ...]) -> tuple[tuple[int, ...], Block]:
        """In a polling tick, move the servo whose turn it is to the end."""
        self._tick += 1
        urgent = [place for place in self._alerting if self._cause_unknown(place)]
        due = urgent or self._tick % POLL_EVERY == 0
        if not due or any(place in members for place in self._chain.silent):
            return members, HOT
        self._polled += not urgent
        place = urgent[0] if urgent else members[self._polled % len(members)]
        block = FAULT if place in self._alerting else SLOW
        self._writer.refresh(place)
        return (*(p for p in members if p != place), place), block

    def _cause_unknown(self, place: int) -> bool:
        return int(self._states.error[self.servos[place].joint]) == ALERT_UNKNOWN

    def _plan_for(self, members: tuple[int, ...], last: Block) -> tuple[ReadPlan, Ints]:
        key = (members, last, self.fast)
        if key not in self._plans:
            ids = [self.servos[place].id for place in members]
            plan = plan_read(members, ids, last, self.fast, self.timing, TIMEOUT_MARGIN_NS)
            joints = [self.servos[place].joint for place in members]
            self._plans[key] = (plan, np.array(joints, dtype=np.int64))
        return self._plans[key]

    def _take_whole(self, plan: ReadPlan, raw: bytes) -> bool:
        """Decode a fast answer that is as long as it should be."""
        if crc16(raw[:-2]) != raw[-2] | raw[-1] << 8:
            return True
        count = len(plan.ids) if plan.last is HOT else len(plan.ids) - 1
        blocks = np.frombuffer(raw, HOT_DTYPE, count, _FAST_START)
        if (
            self._alerting
            or blocks["error"].any()
            or blocks["id"].tobytes() != (plan.id_bytes[:count])
        ):
            return True
        joints = self._joints[:count]
        states = self._states
        states.position[joints] = blocks["position"]
        states.velocity[joints] = blocks["velocity"]
        states.current[joints] = blocks["current"]
        states.valid[joints] = True
        states.time_ns[joints] = self._sample_ns
        self._heard.update(plan.members[:count])
        if plan.last is not HOT:
            tail = raw[-(plan.last.length + 4) : -2]
            self._take(plan, FastBlock(tail[0], tail[1], tail[2:]))
        if self._chain.silent:
            for place in plan.members:
                self._chain.heard(place)
        self._fast_failures = None
        return True

    def _collect_plain(self, plan: ReadPlan, data: bytes) -> bool:
        """Take the status packets of a plain read."""
        errors = self._reader.crc_errors
        for packet in self._reader.feed(data):
            if packet.is_status and packet.id in plan.ids:
                self._take(plan, FastBlock(packet.error, packet.id, packet.data))
        self.counters.crc_errors += self._reader.crc_errors - errors
        return len(self._heard) == len(plan.members)

    def _salvage(self, plan: ReadPlan) -> None:
        """Take the blocks of a fast answer that can be trusted."""
        start = max(0, self._buffer.find(plan.start))
        blocks = decode_fast_status(self._buffer[start:], plan.lengths)
        for block in blocks:
            self._take(plan, block)
        if blocks:
            self._fast_failures = None
        elif self._fast_failures is not None:
            self._fast_failures += 1
            self.fast = self._fast_failures < FAST_TRIALS

    def _take(self, plan: ReadPlan, servo: FastBlock) -> None:
        """Take one servo's answer, unless it reports that it could not do what it was asked."""
        place = self._place.get(servo.id)
        if place is None or place not in plan.members:
            return
        block = plan.last if place == plan.members[-1] else HOT
        if servo.error & ERROR_MASK or len(servo.data) != block.length:
            return
        joint = self.servos[place].joint
        states = self._states
        values = hot_values(block, servo)
        states.current[joint], states.velocity[joint], states.position[joint] = values
        states.valid[joint] = True
        states.time_ns[joint] = self._sample_ns
        if block is not HOT:
            voltage = block.value(Register.PRESENT_INPUT_VOLTAGE, servo.data)
            states.voltage[joint] = VOLTAGE_UNIT * voltage
            states.temperature[joint] = block.value(Register.PRESENT_TEMPERATURE, servo.data)
        self._take_alert(place, block, servo)
        self._heard.add(place)
        self._chain.heard(place)

    def _take_alert(self, place: int, block: Block, servo: FastBlock) -> None:
        """Keep track of who alerts, and why."""
        joint = self.servos[place].joint
        if not servo.error & ALERT:
            self._alerting.discard(place)
            self._states.error[joint] = 0
            return
        self._alerting.add(place)
        if block is FAULT:
            cause = block.value(Register.HARDWARE_ERROR_STATUS, servo.data)
            self._states.error[joint] = cause
        elif self._states.error[joint] == 0:
            self._states.error[joint] = ALERT_UNKNOWN

    def _note_missing(self, plan: ReadPlan) -> None:
        """Count the failure, and blame the first servo that did not answer if one is silent."""
        silent = next((place for place in plan.members if place not in self._heard), None)
        if silent is None:
            return
        if plan.fast and len(self._buffer) >= plan.reply_size:
            self.counters.crc_errors += 1
            return
        self.counters.timeouts += 1
        self._chain.missed(silent)

    # Writing

    def write(self, goals: ServoGoals) -> None:
        """Send the goals of this bus's servos: positions always, the rest where it changed."""
        self.port.write(self._writer.encode(goals))

    def forget_written(self) -> None:
        """Send everything with the next write (after a reboot or arming)."""
        self._writer.forget()
