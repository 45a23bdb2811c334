"""Do servos make the stiffness and damping that they are asked for? An experiment on virtual ones.

A hoisted robot's yaw joint follows a chirp and steps through the real mapping, driver and servo
loops; stiffness and damping are read off the true motion, not off the servo's own current.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hil.clock import tick_time_ns
from hil.compose import build_robot, feasible_gains, hoist, servo_facts
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats, JointCommand, StopMode
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.session import Session

JOINT = "left_hip_yaw"
"""Turns about the vertical: no gravity. Its leg hangs straight."""
MODES = ("position", "current_position", "current")
RATE_HZ = 300
REACH = 0.05
"""Of chirp and steps [rad]."""
CHIRP_BAND = (0.3, 3.0)
"""[Hz]"""
CHIRP_S, STEP_S, STEPS = 4.0, 0.4, 6
WINDOW = 3
"""Ticks over which momentum is balanced."""
FRICTION_SHARE = 0.01
"""Dry friction of the virtual gear train, of the stall torque (assumed)."""
ARMATURE_SHARE = 0.005
"""Rotor inertia of the virtual servo, of the stall torque [kg·m²/(N·m)]: 0.02 for an XM430-W350
(assumed; 0.0018 was identified on an XL330-M288, which it makes 0.0026)."""
TYPICAL_GAIN = 600
"""P gain whose stiffness is asked for."""
DAMPING_SHARES = {"position": (1.0, 1.5), "current_position": (0.6, 1.0), "current": (0.6, 1.0)}
"""Dampings asked for, as shares of the motor's own back-EMF damping."""
TOLERANCE_PCT = 10.0


@dataclass(frozen=True, slots=True)
class GainRow:
    """One experiment: asked, what the mapping says it sent, and what moved."""

    servo: str
    mode: str
    stiffness: float
    """Asked [N·m/rad]."""
    damping: float
    """Asked [N·m·s/rad]."""
    applied_stiffness: float
    applied_damping: float
    measured_stiffness: float
    measured_damping: float

    @property
    def stiffness_error_pct(self) -> float:
        """Measured against asked."""
        return 100 * (self.measured_stiffness / self.stiffness - 1)

    @property
    def damping_error_pct(self) -> float:
        """Measured against asked."""
        return 100 * (self.measured_damping / self.damping - 1)

    @property
    def good(self) -> bool:
        """Both within the tolerance."""
        worst = max(abs(self.stiffness_error_pct), abs(self.damping_error_pct))
        return worst <= TOLERANCE_PCT


def bench_robot(servo: str, mode: str, stiffness: float, damping: float) -> RobotDescription:
    """The minibiped with another servo in every joint, at that servo's voltage, hiding nothing."""
    description = load_robot("minibiped")
    facts = servo_facts(servo)
    change = {
        "servo": servo,
        "mode": mode,
        "stiffness": stiffness,
        "damping": damping,
        "torque_limit": facts["stall_torque"],
        "velocity_limit": facts["no_load_speed"],
    }
    joints = tuple(joint.model_copy(update=change) for joint in description.joints)
    knees = {name: 0.05 for name in description.joint_names if "knee" in name}
    plant = {
        "draws": None,
        "armature": ARMATURE_SHARE * facts["stall_torque"],
        "joint_friction": FRICTION_SHARE * facts["stall_torque"],
    }
    supply = {"voltage": facts["voltage"], "resistance": 0.0}
    return description.model_copy(
        update={
            "joints": joints,
            "gains": {},
            "start": description.start.model_copy(update={"joints": knees}),
            "plant": description.plant.model_copy(update=plant),
            "supply": description.supply and description.supply.model_copy(update=supply),
        }
    )


def cases(servos: Iterable[str]) -> list[tuple[str, str, float, float]]:
    """Servo, mode, stiffness and damping of every experiment; modes a servo lacks are left out."""
    found = []
    for servo in servos:
        facts = servo_facts(servo)
        for mode in MODES:
            limits = feasible_gains(servo, mode)
            if limits is None:
                continue
            stiffness = TYPICAL_GAIN * facts["position_stiffness"]
            found += [
                (servo, mode, stiffness, share * facts["back_emf_damping"])
                for share in DAMPING_SHARES[mode]
            ]
    return found


def measure_gains(servo: str, mode: str, stiffness: float, damping: float, backend: str) -> GainRow:
    """One experiment. Raises InputError for gains that the servo cannot have."""
    description = bench_robot(servo, mode, stiffness, damping)
    request = RunRequest.checked(backend=backend, rate_hz=RATE_HZ)
    session = build_robot(request, description)
    try:
        inertia = hoist(session, JOINT)
        motion = _move(session, description.joint_names.index(JOINT))
    finally:
        session.backend.stop(StopMode.TORQUE_OFF)
        session.close()
    measured = fit_gains(motion, inertia, 1.0 / RATE_HZ)
    return GainRow(
        servo, mode, stiffness, damping, motion.stiffness, motion.damping, measured[0], measured[1]
    )


@dataclass(frozen=True, slots=True)
class Motion:
    """What one joint was asked and what it did, at every tick."""

    goal: Floats
    """[rad], shape (ticks,); stands from its tick to the next."""
    goal_velocity: Floats
    """[rad/s]"""
    position: Floats
    """True [rad]."""
    velocity: Floats
    """True [rad/s]."""
    stiffness: float
    """Applied, mean of all ticks [N·m/rad]."""
    damping: float
    """[N·m·s/rad]"""


def excitation() -> tuple[Floats, Floats]:
    """Chirp, then steps: goals [rad] and their velocities [rad/s], shape (ticks,)."""
    low, high = CHIRP_BAND
    time = np.arange(round(CHIRP_S * RATE_HZ)) / RATE_HZ
    growth = np.log(high / low) / CHIRP_S
    omega = 2 * np.pi * low * np.exp(growth * time)
    phase = (omega - omega[0]) / growth
    places = REACH * np.resize([1.0, -1.0, 0.5, -0.5], STEPS)
    steps = np.repeat(places, round(STEP_S * RATE_HZ))
    goal = np.concatenate((REACH * np.sin(phase), steps))
    velocity = np.concatenate((REACH * omega * np.cos(phase), np.zeros(steps.size)))
    return goal, velocity


def _move(session: Session, joint: int) -> Motion:
    backend, world, joints = session.backend, session.world, session.description.joints
    if world is None:
        raise InputError("gains are measured on a virtual robot")
    goal, goal_velocity = excitation()
    command = JointCommand.zeros(len(joints))
    command.position[:] = session.description.start_position
    command.stiffness[:] = [one.stiffness for one in joints]
    command.damping[:] = [one.damping for one in joints]
    backend.open()
    backend.read()
    backend.arm()
    begin, settle = backend.clock.now_ns(), round(0.5 * RATE_HZ)
    rows = []
    for tick in range(settle + goal.size):
        backend.clock.sleep_until_ns(tick_time_ns(begin, tick, RATE_HZ))
        truth = world.truth()
        state = float(truth.joint_position[joint]), float(truth.joint_velocity[joint])
        backend.read()
        if tick >= settle:
            command.position[joint] = goal[tick - settle]
            command.velocity[joint] = goal_velocity[tick - settle]
        applied = backend.write(command)
        if tick >= settle:
            rows.append((*state, float(applied.stiffness[joint]), float(applied.damping[joint])))
    position, velocity, stiffness, damping = np.array(rows).T
    means = float(stiffness.mean()), float(damping.mean())
    return Motion(goal, goal_velocity, position, velocity, *means)


def fit_gains(motion: Motion, inertia: float, period_s: float) -> tuple[float, float]:
    """Stiffness and damping of J·Δω = kp·∫(q* − q) + kd·∫(q̇* − q̇) − f·∫sgn ω over windows.

    Goals act some time after their tick, which is no fault of the gains: of delays from none to
    three ticks the one that leaves least over is taken. Dry friction f is fitted along.
    """
    found = [
        _fit_at(motion, inertia, period_s, delay) for delay in np.arange(0.0, 3.01, 0.1) * period_s
    ]
    _, stiffness, damping = min(found)
    return stiffness, damping


def _fit_at(
    motion: Motion, inertia: float, period_s: float, delay_s: float
) -> tuple[float, float, float]:
    """Residual, stiffness and damping for a delay [s]."""
    starts = np.arange(4, motion.position.size - WINDOW, WINDOW)

    def between(running: Floats) -> Floats:
        part: Floats = running[starts + WINDOW] - running[starts]
        return part

    def smooth(values: Floats) -> Floats:
        return np.concatenate(([0.0], np.cumsum(0.5 * period_s * (values[1:] + values[:-1]))))

    def held(values: Floats) -> Floats:
        time = np.arange(values.size) * period_s
        running = np.concatenate(([0.0], np.cumsum(values[:-1]) * period_s))
        late: Floats = np.interp(time - delay_s, time, running)
        return late

    table = np.column_stack(
        (
            between(held(motion.goal) - smooth(motion.position)),
            between(held(motion.goal_velocity)) - between(motion.position),
            -between(smooth(np.sign(motion.velocity))),
            np.full(starts.size, WINDOW * period_s),
        )
    )
    right = inertia * between(motion.velocity)
    values, *_ = np.linalg.lstsq(table, right, rcond=None)
    residual = right - table @ values
    return float(residual @ residual), float(values[0]), float(values[1])
