"""`stride identify`: move one joint of a held robot through the real driver, and fit its servo."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from hil.errors import BackendError, InputError, UnknownNameError
from hil.guarded_runner import GuardedRunner
from hil.identify_excitation import Excitation, make_excitation
from hil.identify_fit import ServoFit, fit_servo
from hil.identify_load import joint_load
from hil.identify_record import JointRecord
from hil.interface import Floats, JointCommand, SensorFrame
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN, MotorParameters, ServoGoals
from hil.session import Session
from hil.shutdown import stop_and_close
from hil.signals import StopSignals
from hil.start_plan import RAMP_S
from hil.startup import PoseRamp, default_command

VOLTAGE_FILTER_S = 0.5
"""Time constant over which voltage readings are averaged."""


@dataclass(frozen=True, slots=True)
class Rig:
    """A robot that hangs with its feet free, and what the driver knows of its servos."""

    session: Session
    goals: Callable[[], ServoGoals | None]
    """Registers of the last write."""
    motors: MotorParameters
    """Constants that the driver counts with."""
    offsets: Floats
    """Servo-frame angles of the joints' zeros [rad], shape (n,)."""
    keep: Callable[[Path, "Identified"], None]
    """Writes what was found into a calibration file, made where there is none."""
    hidden: dict[str, float] = field(default_factory=dict)
    """True values of the joint's servo, by key of `ServoFit`, where the robot is virtual."""


class _Samples:
    """What one joint measured and was told, tick by tick."""

    def __init__(self, rig: Rig, joint: int, rate_hz: int) -> None:
        self._rig = rig
        self._joint = joint
        self._share = 1.0 / (VOLTAGE_FILTER_S * rate_hz)
        self._voltage: float | None = None
        self._rows: list[tuple[float, ...]] = []
        self.invalid = 0
        """Ticks in which the joint was not heard."""

    def put(self, frame: SensorFrame) -> None:
        """Keep the tick of a frame, after its goals were written."""
        joint, goals = self._joint, self._rig.goals()
        if goals is None:
            raise BackendError("identify: the driver wrote nothing in this tick")
        known = frame.joint_voltage[np.isfinite(frame.joint_voltage)]
        if known.size:
            mean = float(known.mean())
            before = mean if self._voltage is None else self._voltage
            self._voltage = before + self._share * (mean - before)
        self.invalid += not frame.joint_valid[joint]
        self._rows.append(
            (
                float(frame.joint_position[joint]),
                float(frame.joint_velocity[joint]),
                float(frame.joint_torque[joint]),
                self._voltage or float("nan"),
                float(goals.position[joint]),
                float(goals.p_gain[joint]),
            )
        )

    def record(self, period_s: float) -> JointRecord:
        """Everything kept, in joint direction and SI."""
        joint, motors = self._joint, self._rig.motors
        position, velocity, torque, voltage, counts, gain = np.array(self._rows).T
        direction = float(motors.direction[joint])
        goal = direction * (counts - CENTRE_COUNTS) / COUNTS_PER_RADIAN
        return JointRecord(
            period_s,
            position,
            velocity,
            torque / float(motors.torque_constant[joint]),
            voltage,
            goal - float(self._rig.offsets[joint]),
            gain,
        )


class _Mover:
    """Holds the start pose and lets one joint follow an excitation."""

    def __init__(self, session: Session, joint: int, excitation: Excitation) -> None:
        self._joint = joint
        self._goal = excitation.goal
        self._next = 0
        self._command = default_command(session)

    def command(self) -> JointCommand:
        """The command of the next tick."""
        self._command.position[self._joint] = self._goal[self._next]
        self._next += 1
        return self._command


@dataclass(frozen=True, slots=True)
class Identified:
    """One joint's result."""

    joint: str
    method: str
    """Which tests, on what."""
    fit: ServoFit
    record: JointRecord
    ticks_lost: int
    """In which the joint was not heard; its last value stood in."""


def joint_index(names: tuple[str, ...], joint: str) -> int:
    """Place of a joint. Raises UnknownNameError."""
    if joint not in names:
        raise UnknownNameError("joint", joint, names)
    return names.index(joint)


def identify(rig: Rig, joint: str, after_tick: Callable[[int, int], None]) -> Identified:
    """Move a joint and fit its servo; torque is off and the session closed afterwards.

    `after_tick(done, total)` may show progress. Raises InputError for a joint without room or in
    another mode than position, BackendError when the robot had to be stopped.
    """
    session = rig.session
    description = session.description
    rate_hz = session.request.rate_hz or description.defaults.rate_hz
    try:
        index = joint_index(description.joint_names, joint)
        own = description.joints[index]
        if own.mode != "position":
            raise InputError(f"joint {joint}: is identified in mode position, not {own.mode}")
        centre = description.start_position[index]
        excitation = make_excitation(own, centre, rate_hz)
        session.backend.open()
    except BaseException:
        session.close()
        raise
    samples = _move(rig, index, excitation, rate_hz, after_tick)
    record = samples.record(1.0 / rate_hz)
    fit = fit_servo(record, joint_load(description, index), float(rig.motors.resistance[index]))
    world = "real" if session.world is None else f"virtual (seed {session.request.seed})"
    method = f"sweep, steps and chirp of a {world} servo"
    return Identified(joint, method, fit, record, samples.invalid)


def _move(
    rig: Rig,
    joint: int,
    excitation: Excitation,
    rate_hz: int,
    after_tick: Callable[[int, int], None],
) -> _Samples:
    """Ramp to the start pose, move the joint, and end with torque off in any case."""
    session, signals = rig.session, StopSignals()
    samples = _Samples(rig, joint, rate_hz)
    with signals.caught():
        try:
            runner = GuardedRunner(session, rate_hz)
            present = runner.await_sensors(signals.check)
            session.backend.arm()
            runner.begin()
            ramp_ticks = round(RAMP_S * rate_hz)
            ramp = PoseRamp(session, present, ramp_ticks)
            mover = _Mover(session, joint, excitation)
            total = ramp_ticks + excitation.goal.size
            for tick in range(total):
                if tick < ramp_ticks:
                    runner.tick(ramp.step())
                else:
                    samples.put(runner.tick(mover.command()))
                signals.check()
                after_tick(tick + 1, total)
        finally:
            with signals.shielded():
                stop_and_close(session)
    return samples
