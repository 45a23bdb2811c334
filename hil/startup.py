"""From switched off to standing: hear every sensor, arm, ramp to the start pose, stand, settle."""

from collections.abc import Callable

import numpy as np

from hil.cycle import Cycle
from hil.errors import BackendError
from hil.interface import Estimate, Floats, JointCommand, Reference
from hil.safety import Fault, never_heard
from hil.session import Session

RAMP_S = 1.0
"""Time from the present pose to the start pose."""
SETTLE_S = 0.5
"""Time on the robot's own feet before T = 0."""
SENSOR_TIMEOUT_S = 1.0
"""A joint or board that has not been heard of by then is missing."""


def await_sensors(session: Session, cycle: Cycle, after_tick: Callable[[], None]) -> Floats:
    """Read until every joint and board has answered; the pose found, shape (n,) [rad].

    Raises BackendError naming who is silent. Nothing is sent that could move a servo.
    """
    silent: list[str] = []
    cycle.begin(0)
    while cycle.schedule.next_tick < SENSOR_TIMEOUT_S * cycle.rate_hz:
        cycle.schedule.wait()
        frame = session.backend.read()
        cycle.schedule.finish()
        after_tick()
        silent = never_heard(session.description, frame)
        if not silent:
            return frame.joint_position.copy()
    raise BackendError(
        f"{session.description.name}: nothing heard of {', '.join(silent)} "
        f"in {SENSOR_TIMEOUT_S:g} s; nothing was armed"
    )


def stand_up(session: Session, cycle: Cycle, after_tick: Callable[[], None]) -> Fault | None:
    """Ticks before T = 0: ramp while the body is held, let it go, settle.

    `after_tick` may raise to break off. Returns the fault that forbids walking, or none.
    """
    present = await_sensors(session, cycle, after_tick)
    ramp_ticks, settle_ticks = (round(time * cycle.rate_hz) for time in (RAMP_S, SETTLE_S))
    session.backend.arm()
    cycle.begin(-ramp_ticks - settle_ticks)
    pose = PoseRamp(session, present, ramp_ticks)
    for until, supported in ((-settle_ticks, True), (0, False)):
        if session.world is not None:
            session.world.set_support(supported)
        while cycle.schedule.next_tick < until:
            fault = cycle.tick(pose.command)
            after_tick()
            if fault is not None:
                return fault
    return None


class PoseRamp:
    """Moves every joint from the present pose to the start pose, smoothly, and holds it.

    The share of the way is 3s² − 2s³ for s from 0 to 1: no velocity at either end.
    """

    def __init__(self, session: Session, present: Floats, ticks: int) -> None:
        joints = session.description.joints
        self._present = present
        self._way = np.array(session.description.start_position) - present
        self._ticks = ticks
        self._done = 0
        self._command = JointCommand.zeros(len(joints))
        self._command.stiffness[:] = [joint.stiffness for joint in joints]
        self._command.damping[:] = [joint.damping for joint in joints]

    def command(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of the next tick."""
        del estimate, reference  # The ramp is the same whatever the robot does.
        self._done = min(self._done + 1, self._ticks)
        s = self._done / self._ticks
        np.multiply(self._way, s * s * (3.0 - 2.0 * s), out=self._command.position)
        self._command.position += self._present
        return self._command
