"""The contract between controller, loop and backends. It imports nothing of ours.

SI units everywhere: m, s, kg, N, rad. Time stamps are integer nanoseconds of one injected clock.
Quaternions are (w, x, y, z). World and base frames: x forward, y left, z up. n is the number of
joints, in the order of the robot description. Feet are ordered (left, right), the corners of each
foot (front_left, front_right, rear_left, rear_right), forces in newtons, positive in compression.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum, IntFlag
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

SIDES = ("left", "right")
CORNERS = ("front_left", "front_right", "rear_left", "rear_right")
GRAVITY = 9.81
"""On the ground that robots stand on [m/s²]."""
NEVER_NS = np.iinfo(np.int64).max
"""Age of a value that was never received."""


class Limit(IntFlag):
    """Which limit changed a joint's command on its way to the actuator."""

    NONE = 0
    POSITION = 1
    """Position goal outside the joint's range, clamped."""
    VELOCITY = 2
    """Goal moved faster than the joint may, rate-limited."""
    TORQUE = 4
    """Torque beyond the joint's limit, clamped."""
    STIFFNESS = 8
    """Stiffness that the actuator cannot realise, clamped."""
    DAMPING = 16
    """Damping that the actuator cannot realise, clamped."""
    SATURATION = 32
    """The goal is so far from the joint that the actuator's drive saturates."""
    HELD = 64
    """Not sent: the last goal stands."""


class JointError(IntFlag):
    """What `SensorFrame.joint_error` says beyond the actuator's own error bits (below 0x80)."""

    UNEXPLAINED = 0x80
    """The actuator alerts, and why is not read yet."""
    REBOOTED = 0x100
    """Its clock began anew: it started again, with torque off and its gains lost."""
    TORQUE_LOST = 0x200
    """Torque is off although it was switched on."""
    STOPPED = 0x400
    """Its watchdog tripped: it holds where it is and takes no goals."""


class StopMode(Enum):
    """How `Backend.stop` ends motion."""

    SOFT = "soft"
    """Hold the last position goal; torque stays on."""
    TORQUE_OFF = "torque_off"
    """Torque off now, read back until verified."""


@dataclass(slots=True)
class JointCommand:
    """One command for every joint, arrays of shape (n,).

    Joint j is asked for the torque
    `stiffness[j]*(position[j] - q[j]) + damping[j]*(velocity[j] - qd[j]) + torque[j]`.
    """

    position: Floats
    """[rad]"""
    velocity: Floats
    """[rad/s]"""
    stiffness: Floats
    """[N·m/rad]"""
    damping: Floats
    """[N·m·s/rad]"""
    torque: Floats
    """Feed-forward torque [N·m]."""

    @classmethod
    def zeros(cls, n: int) -> "JointCommand":
        """A command that asks for no torque of any of n joints."""
        return cls(*(np.zeros(n) for _ in range(5)))

    def is_finite(self) -> bool:
        """Whether every number of the command is finite."""
        total = self.position.sum() + self.velocity.sum() + self.stiffness.sum()
        return bool(np.isfinite(total + self.damping.sum() + self.torque.sum()))


@dataclass(slots=True)
class AppliedCommand:
    """What was really sent, joint by joint: the command after limits and quantisation."""

    position: Floats
    """Goal realised by the actuator, without the shift that carries torque and velocity [rad]."""
    velocity: Floats
    """[rad/s]"""
    stiffness: Floats
    """[N·m/rad]"""
    damping: Floats
    """[N·m·s/rad]"""
    torque: Floats
    """[N·m]"""
    limit: Ints
    """`Limit` flags that acted, shape (n,)."""
    goal: Floats
    """What the actuator's own controller was told [rad]: the position with the shift that carries
    torque and velocity; 0 of an actuator that takes torques."""
    p_gain: Ints
    """Its proportional gain, register value; 0 where it has none."""

    @classmethod
    def zeros(cls, n: int) -> "AppliedCommand":
        """An applied command of n joints with nothing sent."""
        position, velocity, stiffness, damping, torque, goal = np.zeros((6, n))
        limit, p_gain = np.zeros((2, n), dtype=np.int64)
        return cls(position, velocity, stiffness, damping, torque, limit, goal, p_gain)


@dataclass(slots=True)
class SensorFrame:
    """Everything measured in one tick. Invalid values are the last valid ones, never zero-filled.

    Ages count from acquisition to `time_ns`; `NEVER_NS` where nothing was ever received.
    """

    time_ns: int
    """Clock time of the tick that this frame belongs to."""
    joint_position: Floats
    """[rad], shape (n,)."""
    joint_velocity: Floats
    """[rad/s], shape (n,)."""
    joint_torque: Floats
    """Estimated actuator torque [N·m], shape (n,)."""
    joint_temperature: Floats
    """[°C], shape (n,); NaN where unknown."""
    joint_voltage: Floats
    """Supply at the servo [V], shape (n,); NaN where unknown."""
    joint_error: Ints
    """Hardware error flags of the actuator and `JointError`, 0 = none, shape (n,)."""
    joint_age_ns: Ints
    """Shape (n,)."""
    joint_valid: Bools
    """Shape (n,): received in this tick."""
    imu_present: bool
    """The robot has an IMU."""
    imu_orientation: Floats
    """Base to world, (w, x, y, z)."""
    imu_angular_velocity: Floats
    """In base axes [rad/s]."""
    imu_linear_acceleration: Floats
    """Specific force in base axes [m/s²]."""
    imu_age_ns: int
    imu_valid: bool
    foot_force: Floats
    """Corner forces [N], shape (2, 4)."""
    foot_age_ns: Ints
    """Shape (2,)."""
    foot_valid: Bools
    """Shape (2, 4)."""

    @classmethod
    def empty(cls, n: int, imu_present: bool = True) -> "SensorFrame":
        """A frame of n joints in which nothing was received yet."""
        nan = np.full(n, np.nan)
        return cls(
            0,
            np.zeros(n),
            np.zeros(n),
            np.zeros(n),
            nan,
            nan.copy(),
            np.zeros(n, dtype=np.int64),
            np.full(n, NEVER_NS, dtype=np.int64),
            np.zeros(n, dtype=np.bool_),
            imu_present,
            np.array([1.0, 0.0, 0.0, 0.0]),
            np.zeros(3),
            np.array([0.0, 0.0, GRAVITY]),
            NEVER_NS,
            False,
            np.zeros((2, 4)),
            np.full(2, NEVER_NS, dtype=np.int64),
            np.zeros((2, 4), dtype=np.bool_),
        )


@dataclass(slots=True)
class Truth:
    """Ground truth of a simulated robot. It never enters a SensorFrame."""

    time_ns: int
    base_position: Floats
    """World position of the root body's origin [m], shape (3,)."""
    base_orientation: Floats
    """Base to world, (w, x, y, z)."""
    base_linear_velocity: Floats
    """Velocity of the root body's origin in world axes [m/s], shape (3,)."""
    base_angular_velocity: Floats
    """In base axes [rad/s], shape (3,)."""
    joint_position: Floats
    """[rad], shape (n,)."""
    joint_velocity: Floats
    """[rad/s], shape (n,)."""
    com: Floats
    """World position of the whole-body centre of mass [m], shape (3,)."""
    com_velocity: Floats
    """World velocity of the centre of mass [m/s], shape (3,)."""
    foot_force: Floats
    """Normal corner forces [N], shape (2, 4)."""
    toe_force: Floats
    """Normal force on each foot's separate toe body, 0 without one [N], shape (2,)."""


@dataclass(slots=True)
class Estimate:
    """What the controller believes: the state of the robot made from one or more frames."""

    time_ns: int
    base_position: Floats
    """World position of the root body's origin [m], shape (3,)."""
    base_orientation: Floats
    """Base to world, (w, x, y, z)."""
    base_linear_velocity: Floats
    """World axes [m/s], shape (3,)."""
    base_angular_velocity: Floats
    """Base axes [rad/s], shape (3,)."""
    joint_position: Floats
    """[rad], shape (n,)."""
    joint_velocity: Floats
    """[rad/s], shape (n,)."""
    com: Floats
    """World position of the whole-body centre of mass [m], shape (3,)."""
    com_velocity: Floats
    """World axes [m/s], shape (3,)."""
    foot_force: Floats
    """Filtered corner forces [N], shape (2, 4)."""
    toe_force: Floats
    """Force on each separate toe body, 0 without one [N], shape (2,)."""
    contact: Bools
    """Whether each foot is on the ground, shape (2,)."""
    supply_voltage: float
    """Servo supply [V]; NaN where unknown."""


@dataclass(slots=True)
class Reference:
    """What the operator asks for in one tick."""

    speed: float = 0.0
    """Sagittal speed along the heading [m/s]."""
    lateral: float = 0.0
    """Coronal speed, left positive [m/s]."""
    heading: float = 0.0
    """Heading angle in the world [rad], left positive, not wrapped."""
    step_width: float = float("nan")
    """Lateral distance between the feet [m]; NaN for the robot's own."""
    water_level: float = 0.0
    """Level of the liquid that the robot is told to expect, above the floor [m]; 0 is dry land."""
    liquid_density: float = 1000.0
    """[kg/m³]"""
    liquid_viscosity: float = 1.0
    """Factor on the drag, 1 for water."""


@dataclass(slots=True)
class WalkStatus:
    """What the controller did in the last tick, for recordings and reports."""

    phase: float = 0.0
    """Phase of the current step, 0 at its start, about 1 at touch-down."""
    stance: int = 0
    """Index of the stance foot: 0 left, 1 right."""
    steps: int = 0
    """Footsteps completed."""
    walking: bool = False
    """False while standing or shifting weight before the first step."""
    foot_flat: bool = False
    """The stance foot lies flat (latched for the step)."""
    stabilizer_iterations: int = 0
    stabilizer_limited: bool = False
    foot_target: Floats = field(default_factory=lambda: np.zeros(3))
    """World target of the swing ankle [m], shape (3,)."""
    heading: float = 0.0
    """Heading that the controller tracks in this tick [rad]."""
    alteration: float = 0.0
    """Sagittal distance that speed errors have added to the steps, Δ [m]."""
    recovering: bool = False
    """The present step is a recovery step."""
    wanted_speed: float = float("nan")
    """Sagittal speed that is wanted at this phase of the step: the commanded one with the learnt
    curve and its offset [m/s]; NaN of a controller that has no curve."""


class Clock(Protocol):
    """One time for everything. Virtual in lockstep, monotonic in real time."""

    def now_ns(self) -> int:
        """Current time [ns]."""
        ...

    def sleep_until_ns(self, time_ns: int) -> None:
        """Return when the time has come; at once if it is past."""
        ...

    def wait_readable(self, ports: Sequence["Readable"], deadline_ns: int) -> None:
        """Return when one of the ports has bytes to read, or at the deadline."""
        ...


class Readable(Protocol):
    """A byte stream that a Clock can wait for: pyserial's posix ports and our virtual ones."""

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        ...

    def fileno(self) -> int:
        """File descriptor, for streams that have one."""
        ...


class Estimator(Protocol):
    """Turns frames into estimates."""

    def update(self, frame: SensorFrame) -> Estimate:
        """The estimate at the frame's time. The returned object is reused by the next call."""
        ...


class Controller(Protocol):
    """Turns estimates into joint commands."""

    status: WalkStatus

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of this tick. The returned object is reused by the next call."""
        ...


class World(Protocol):
    """A simulated surrounding: ground truth and disturbances, never part of a Backend's frames."""

    def truth(self) -> Truth:
        """State of the body now. The returned object is reused by the next call."""
        ...

    def set_push(self, force: Floats) -> None:
        """Force at the centre of mass of the root body, world axes [N], until set again."""
        ...

    def throw_ball(self, mass: float, velocity: Floats) -> None:
        """Throw a ball [kg] at the trunk, to hit it at a world velocity [m/s], shape (3,)."""
        ...

    def set_medium(self, level: float, density: float, viscosity: float) -> None:
        """A liquid up to a level above the floor [m], its density [kg/m³] and viscosity factor."""
        ...

    def set_support(self, supported: bool) -> None:
        """Hold the root body where it is, as a hand would, or let it go."""
        ...


class Backend(Protocol):
    """Actuators and sensors of one robot, simulated or real."""

    @property
    def name(self) -> str:
        """Of the backend, as the command line names it."""
        ...

    @property
    def changes(self) -> Sequence[str]:
        """What `open` corrected or found wanting, a line each, for the operator."""
        ...

    @property
    def clock(self) -> Clock:
        """The time on which this backend lives."""
        ...

    def open(self) -> None:
        """Connect and check; torque stays as it is found. Raises BackendError or InputError."""
        ...

    def read(self) -> SensorFrame:
        """The frame of this tick. The returned object is reused by the next call."""
        ...

    def arm(self) -> None:
        """Adopt the present position as goal, then enable torque."""
        ...

    def write(self, command: JointCommand) -> AppliedCommand:
        """Send a command; raises InvalidCommandError and sends nothing if it is not finite."""
        ...

    def stop(self, mode: StopMode) -> bool:
        """End motion; True when the result was read back."""
        ...

    def close(self) -> None:
        """Release ports and processes. Safe to call twice, and after an error."""
        ...

    def statistics(self) -> dict[str, float | None]:
        """Counters for the report: keys as in `docs/reports.md`, None where they do not apply."""
        ...
