"""Small stand-ins for backend, estimator, controller and world, on a manual clock."""

import numpy as np

from hil.clock import ManualClock
from hil.interface import (
    AppliedCommand,
    Estimate,
    JointCommand,
    SensorFrame,
    StopMode,
    Truth,
    WalkStatus,
)
from hil.record_layout import topics
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.session import Session

JOINTS = 12
WALKING_TICK = 100


class FakeBackend:
    """Perfect joints, and a journal of what was done to them."""

    name = "fake"
    changes = ("left_knee: Return Delay Time 250 -> 0",)

    def __init__(self, clock=None):
        self.clock = clock or ManualClock()
        self.frame = SensorFrame.empty(JOINTS)
        self.frame.joint_age_ns[:] = 0
        self.frame.joint_valid[:] = True
        self.frame.joint_position[[3, 9]] = 0.1  # knees, inside their range
        self.frame.imu_age_ns = 0
        self.frame.foot_age_ns[:] = 0
        self.frame.foot_valid[:] = True
        self.frame.foot_force[:] = 25.7 / 8
        self.applied = AppliedCommand.zeros(JOINTS)
        self.journal = []
        self.written = []
        self.verify_after = 1
        self.raise_in = {}
        self.reads = 0

    def _maybe_raise(self, stage):
        error = self.raise_in.get(stage)
        if error is not None and self.reads > WALKING_TICK:
            raise error

    def open(self):
        self.journal.append("open")
        if "open" in self.raise_in:
            raise self.raise_in["open"]

    def read(self):
        self.reads += 1
        self._maybe_raise("read")
        self.frame.time_ns = self.clock.now_ns()
        return self.frame

    def arm(self):
        self.journal.append("arm")

    def write(self, command):
        self._maybe_raise("write")
        self.written.append(command.position.copy())
        self.applied.position[:] = command.position
        self.applied.limit[:] = 0
        self.frame.joint_position[:] = command.position
        return self.applied

    def stop(self, mode):
        self.journal.append(mode.value)
        if mode is StopMode.TORQUE_OFF:
            self.verify_after -= 1
            return self.verify_after <= 0
        return True

    def close(self):
        self.journal.append("close")

    def statistics(self):
        return {"voltage_min_v": float("nan")}


class FakeEstimator:
    """Believes that the body stands at 0.25 m and walks at `speed`."""

    def __init__(self, backend, speed=0.15):
        self.estimate: Estimate = topics(JOINTS, truth=False)["estimate"]
        # separate arrays: the blank one shares them
        for name in ("base_position", "base_linear_velocity", "base_angular_velocity", "com"):
            setattr(self.estimate, name, np.zeros(3))
        self.estimate.base_orientation = np.array([1.0, 0.0, 0.0, 0.0])
        self.estimate.base_position[2] = 0.25
        self.estimate.com_velocity = np.array([speed, 0.0, 0.0])
        self.speed = speed
        self.backend = backend
        self.raising = None

    def update(self, frame):
        if self.raising is not None and self.backend.reads > WALKING_TICK:
            raise self.raising
        self.estimate.com[0] = self.speed * frame.time_ns * 1e-9
        self.estimate.joint_position[:] = frame.joint_position
        return self.estimate


class FakeController:
    """Holds the knees bent and counts a step every 0.3 s."""

    def __init__(self, backend, rate_hz):
        self.status = WalkStatus()
        self.command = JointCommand.zeros(JOINTS)
        self.command.stiffness[:] = 10.0
        self.command.position[:] = 0.1
        self.backend = backend
        self.rate_hz = rate_hz
        self.ticks = 0
        self.raising = None
        self.references = []

    def step(self, estimate, reference):
        if self.raising is not None and self.backend.reads > WALKING_TICK:
            raise self.raising
        self.references.append((reference.speed, reference.heading))
        self.status.walking = True
        self.status.steps = int(self.ticks / self.rate_hz / 0.3)
        self.status.stance = self.status.steps % 2
        self.ticks += 1
        return self.command


class FakeWorld:
    """A truth that moves with the estimate, and a journal of pushes."""

    def __init__(self, estimator):
        self.estimator = estimator
        self.pushes = []
        self.balls = []
        self.media = []
        self.support = []
        self.truth_now: Truth = topics(JOINTS, truth=True)["truth"]
        self.truth_now.base_position = np.array([0.0, 0.0, 0.25])
        self.truth_now.base_orientation = np.array([1.0, 0.0, 0.0, 0.0])

    def truth(self):
        self.truth_now.com = self.estimator.estimate.com.copy()
        return self.truth_now

    def set_push(self, force):
        self.pushes.append(tuple(force))

    def throw_ball(self, mass, velocity):
        self.balls.append((mass, tuple(velocity)))

    def set_medium(self, level, density, viscosity):
        self.media.append((level, density, viscosity))

    def set_support(self, supported):
        self.support.append(supported)


def make_session(*, world=False, clock=None, meta=None, **request):
    """A session of fakes that behave as minibiped's parts do."""
    description = load_robot("minibiped")
    request.setdefault("duration_s", 1.0)
    resolved = RunRequest.checked(robot="minibiped", **request).resolved(description)
    backend = FakeBackend(clock)
    estimator = FakeEstimator(backend)
    controller = FakeController(backend, resolved.rate_hz)
    return Session(
        resolved,
        description,
        backend,
        estimator,
        controller,
        FakeWorld(estimator) if world else None,
        meta or {},
    )


class Collector:
    """A sink that keeps tick numbers and cycle times."""

    def __init__(self):
        self.ticks = []
        self.times_ns = []

    def put(self, record):
        self.ticks.append(record.timing.tick)
        self.times_ns.append(record.time_ns)
