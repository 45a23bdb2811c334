"""From switched off to standing: hear every sensor, arm, ramp to the start pose, stand, settle."""

from collections.abc import Callable

import numpy as np

from hil.cycle import Cycle
from hil.errors import BackendError
from hil.interface import Estimate, Floats, JointCommand, Reference
from hil.safety.decision import Action
from hil.safety.silence import never_heard
from hil.session import Session

RAMP_S = 1.0
"""Time from the present pose to the start pose."""
SETTLE_S = 0.5
"""Time on the robot's own feet before T = 0."""
RANGE_MARGIN = 0.1
"""A present position may be so far outside the joint's range [rad]: stops give way a little."""
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


def stand_up(
    session: Session, cycle: Cycle, check: Callable[[], None], listen: Callable[[], None]
) -> Action:
    """Ticks before T = 0: ramp while the body is held, let it go, settle.

    `check` is called after every tick before arming, and may raise to break off; `listen` after
    every tick with torque on. Returns RUN, or how the supervisor ended it. Raises
    BackendError for a pose in which no joint may be armed.
    """
    present = await_sensors(session, cycle, check)
    _require_in_range(session, present)
    ramp_ticks, settle_ticks = (round(time * cycle.rate_hz) for time in (RAMP_S, SETTLE_S))
    session.backend.arm()
    cycle.begin(-ramp_ticks - settle_ticks)
    pose = PoseRamp(session, present, ramp_ticks)
    for until, supported in ((-settle_ticks, True), (0, False)):
        if session.world is not None:
            session.world.set_support(supported)
        while cycle.schedule.next_tick < until:
            action = cycle.tick(pose.command)
            listen()
            if action is not Action.RUN:
                return action
    return Action.RUN


def _require_in_range(session: Session, present: Floats) -> None:
    """A joint far outside its range is a wrong zero or a wrong horn: its torque stays off."""
    outside = [
        f"{joint.name} {angle:.2f} rad (range {joint.range[0]:g} to {joint.range[1]:g})"
        for joint, angle in zip(session.description.joints, present.tolist(), strict=True)
        if not joint.range[0] - RANGE_MARGIN <= angle <= joint.range[1] + RANGE_MARGIN
    ]
    if outside:
        raise BackendError(
            f"{session.description.name}: outside the range: {', '.join(outside)}; nothing was "
            "armed: move the joint by hand, or check its zero and direction"
        )


def default_command(session: Session) -> JointCommand:
    """The start pose with the robot's own gains."""
    joints = session.description.joints
    command = JointCommand.zeros(len(joints))
    command.position[:] = session.description.start_position
    command.stiffness[:] = [joint.stiffness for joint in joints]
    command.damping[:] = [joint.damping for joint in joints]
    return command


class PoseRamp:
    """Moves every joint from the present pose to the start pose, smoothly, and holds it.

    The share of the way is 3s² − 2s³ for s from 0 to 1: no velocity at either end.
    """

    def __init__(self, session: Session, present: Floats, ticks: int) -> None:
        self._present = present
        self._way = np.array(session.description.start_position) - present
        self._ticks = ticks
        self._done = 0
        self._command = default_command(session)

    def command(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of the next tick, for a loop that offers what it knows."""
        del estimate, reference  # The ramp is the same whatever the robot does.
        return self.step()

    def step(self) -> JointCommand:
        """The command of the next tick."""
        self._done = min(self._done + 1, self._ticks)
        s = self._done / self._ticks
        np.multiply(self._way, s * s * (3.0 - 2.0 * s), out=self._command.position)
        self._command.position += self._present
        return self._command
