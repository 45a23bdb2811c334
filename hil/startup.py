"""From switched off to standing: hear every sensor, arm, hold, ramp, be lowered, settle."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hil.cycle import CommandSource, Cycle
from hil.errors import BackendError
from hil.interface import Estimate, Floats, JointCommand, Reference
from hil.robot_facts import body_weight
from hil.safety.decision import Action
from hil.safety.severity import Event, Severity
from hil.safety.silence import never_heard
from hil.session import Session
from hil.smoothstep import smoothstep
from hil.start_plan import start_plan

RANGE_MARGIN = 0.1
"""A present position may be so far outside the joint's range [rad]: stops give way a little."""
SENSOR_TIMEOUT_S = 1.0
"""A joint or board that has not been heard of by then is missing."""
HANGING_SHARE = 0.2
"""Feet that carry more of the weight than this do not hang."""
CARRYING_SHARE = 0.7
"""Feet that carry more of the weight than this stand."""
CARRYING_S = 1.0
"""For so long they must, before the robot counts as standing."""
LONGEST_STAND_S = 600.0
"""A walk that waits for a word waits no longer: servos that hold get warm."""


def await_sensors(session: Session, cycle: Cycle, after_tick: Callable[[], None]) -> Floats:
    """Read until every joint and board has answered; the pose found, shape (n,) [rad].

    Raises BackendError naming who is silent, or for feet that should hang free and carry weight.
    Nothing is sent that could move a servo.
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
            if session.request.hoisted:
                _require_hanging(session, float(frame.foot_force.sum()))
            return frame.joint_position.copy()
    raise BackendError(
        f"{session.description.name}: nothing heard of {', '.join(silent)} "
        f"in {SENSOR_TIMEOUT_S:g} s; nothing was armed"
    )


def stand_up(
    session: Session,
    cycle: Cycle,
    check: Callable[[], None],
    listen: Callable[[], None],
    begun: Callable[[], bool] | None = None,
) -> Action:
    """Ticks before T = 0, in the stages of `start_plan`.

    `check` is called after every tick before arming, and may raise to break off; `listen` after
    every tick with torque on. The robot stands until `begun`, where that is given. Returns RUN, or
    how the supervisor ended it. Raises BackendError for a robot that may not be armed.
    """
    plan = start_plan(session.request, session.description)
    present = await_sensors(session, cycle, check)
    _require_in_range(session, present)
    hold, ramp, wait, settle = plan.ticks(cycle.rate_hz)
    pose = PoseRamp(session, present, ramp, plan.pose, hold)
    # Reads the model's file: not while the servos' watchdogs wait for the next packet.
    least_n = CARRYING_SHARE * body_weight(session.description) if wait else 0.0
    scale = _Scale(pose, least_n, cycle.rate_hz)
    session.backend.arm()
    cycle.begin(-hold - ramp - wait - settle)
    _support(session, plan.supported)
    action = _tick_until(cycle, -wait - settle, pose.command, listen)
    _support(session, False)
    if action is Action.RUN and wait:
        action = _await_weight(cycle, scale, settle, listen)
    if action is Action.RUN and begun is not None:
        cycle.begin(-round(LONGEST_STAND_S * cycle.rate_hz) - settle)
        stage = Stage(pose.command, begun, Event("operator", "never began", Severity.SOFT_STOP))
        action = _await(cycle, stage, settle, listen)
    if action is Action.RUN:
        action = _tick_until(cycle, 0, pose.command, listen)
    return action


def _support(session: Session, supported: bool) -> None:
    if session.world is not None:
        session.world.set_support(supported)


def _tick_until(
    cycle: Cycle,
    until: int,
    source: CommandSource,
    listen: Callable[[], None],
    done: Callable[[], bool] = lambda: False,
) -> Action:
    """Ticks up to a number, or until all is done; RUN, or how the supervisor ended it."""
    action = Action.RUN
    while action is Action.RUN and cycle.schedule.next_tick < until and not done():
        action = cycle.tick(source)
        listen()
    return action


def _await_weight(cycle: Cycle, scale: "_Scale", settle: int, listen: Callable[[], None]) -> Action:
    """Hold the pose until the feet carry the robot; if they never do, sit down."""
    trouble = Event("feet", "never carried the weight", Severity.SOFT_STOP)
    return _await(cycle, Stage(scale.command, lambda: scale.carried, trouble), settle, listen)


@dataclass(frozen=True, slots=True)
class Stage:
    """A part of the start that lasts until something happens."""

    source: CommandSource
    done: Callable[[], bool]
    trouble: Event
    """What it means if it never does."""


def _await(cycle: Cycle, stage: Stage, settle: int, listen: Callable[[], None]) -> Action:
    """Ticks until a stage is done; RUN with `settle` ticks left, or how the supervisor ended it."""
    action = _tick_until(cycle, -settle, stage.source, listen, stage.done)
    if action is Action.RUN and not stage.done():
        cycle.supervisor.note(stage.trouble)
        return cycle.tick(stage.source)
    cycle.begin(-settle)
    return action


class _Scale:
    """Holds a pose and looks at what the feet carry."""

    def __init__(self, pose: "PoseRamp", least_n: float, rate_hz: int) -> None:
        self._pose, self._least_n = pose, least_n
        self._enough = round(CARRYING_S * rate_hz)
        self._ticks = 0

    @property
    def carried(self) -> bool:
        """Whether the feet have carried enough for long enough."""
        return self._ticks >= self._enough

    def command(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The pose's command; counts the ticks with enough load in a row."""
        loaded = float(estimate.foot_force.sum()) > self._least_n
        self._ticks = self._ticks + 1 if loaded else 0
        return self._pose.command(estimate, reference)


def _require_hanging(session: Session, load: float) -> None:
    """A robot whose feet carry it [N] would push itself over with a walk for the air."""
    weight = body_weight(session.description)
    if load > HANGING_SHARE * weight:
        raise BackendError(
            f"{session.description.name}: --hoisted, but its feet carry {load:.1f} N of "
            f"{weight:.1f} N; nothing was armed: hang it up with its feet free, or tare the feet"
        )


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
    """Holds the present pose, moves every joint smoothly to another one, and holds that.

    The share of the way is 3s² − 2s³ for s from 0 to 1: no velocity at either end.
    """

    def __init__(
        self,
        session: Session,
        present: Floats,
        ticks: int,
        pose: Sequence[float] | None = None,
        hold_ticks: int = 0,
    ) -> None:
        """`pose` in joint order [rad]; none for the start pose."""
        goal = session.description.start_position if pose is None else pose
        self._present = present
        self._way = np.array(goal) - present
        self._ticks = ticks
        self._done = -hold_ticks
        self._command = default_command(session)

    def command(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of the next tick, for a loop that offers what it knows."""
        del estimate, reference  # The ramp is the same whatever the robot does.
        return self.step()

    def step(self) -> JointCommand:
        """The command of the next tick."""
        self._done = min(self._done + 1, self._ticks)
        s = max(0, self._done) / self._ticks
        np.multiply(self._way, smoothstep(s), out=self._command.position)
        self._command.position += self._present
        return self._command
