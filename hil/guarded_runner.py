"""Ticks of a robot that hangs in the air: limits on what goes out, an eye on what comes in."""

from collections.abc import Callable

import numpy as np

from hil.errors import BackendError
from hil.interface import NEVER_NS, Floats, JointCommand, SensorFrame
from hil.limits import JointLimits
from hil.safety.silence import MAX_MISSED_TICKS
from hil.session import Session
from hil.startup import SENSOR_TIMEOUT_S
from hil.timing import TickSchedule

MAX_TEMPERATURE = 65.0
"""[°C], below the limit of every servo."""
MAX_ERROR = 0.5
"""Joints further from their goals are stuck, or their load is too heavy [rad]."""
ERROR_TICKS = 60
"""For so long."""


class GuardedRunner:
    """Reads, checks, limits and writes, tick by tick; raises BackendError when a joint is unwell.

    It neither stops nor closes anything: whoever runs it does, whatever it raises.
    """

    def __init__(self, session: Session, rate_hz: int) -> None:
        n = len(session.description.joints)
        self._backend = session.backend
        self._names = session.description.joint_names
        self._rate_hz = rate_hz
        self._limits = JointLimits(session.description)
        self._schedule = TickSchedule(session.backend.clock, rate_hz)
        self._silent = np.zeros(n, dtype=np.int64)
        self._astray = np.zeros(n, dtype=np.int64)

    def begin(self) -> None:
        """The next tick is the first, now."""
        self._schedule = TickSchedule(self._backend.clock, self._rate_hz)

    def await_sensors(self, check: Callable[[], None]) -> Floats:
        """Read until every joint has answered; the pose found [rad], (n,). Sends no goal.

        `check` is called after every tick and may raise to break off.
        """
        self.begin()
        for _ in range(round(SENSOR_TIMEOUT_S * self._rate_hz)):
            self._schedule.wait()
            frame = self._backend.read()
            self._schedule.finish()
            check()
            if (frame.joint_age_ns != NEVER_NS).all():
                return frame.joint_position.copy()
        missing = np.flatnonzero(frame.joint_age_ns == NEVER_NS).tolist()
        names = ", ".join(self._names[joint] for joint in missing)
        raise BackendError(f"nothing heard of {names} in {SENSOR_TIMEOUT_S:g} s; nothing was armed")

    def tick(self, command: JointCommand) -> SensorFrame:
        """One tick; the frame that was read before the command was written, reused."""
        self._schedule.wait()
        frame = self._backend.read()
        self._judge(frame, command)
        self._backend.write(self._limits.apply(command))
        self._schedule.finish()
        return frame

    def _judge(self, frame: SensorFrame, command: JointCommand) -> None:
        self._silent += 1
        self._silent[frame.joint_valid] = 0
        self._astray += 1
        self._astray[np.abs(command.position - frame.joint_position) < MAX_ERROR] = 0
        for bad, what in (
            (self._silent > MAX_MISSED_TICKS, "is silent"),
            (frame.joint_error != 0, "reports a hardware error"),
            (frame.joint_temperature > MAX_TEMPERATURE, f"is hotter than {MAX_TEMPERATURE:g} °C"),
            (self._astray > ERROR_TICKS, f"does not come within {MAX_ERROR:g} rad of its goal"),
        ):
            if np.count_nonzero(bad):
                name = self._names[int(np.flatnonzero(bad)[0])]
                raise BackendError(f"stopped: joint {name} {what}")
