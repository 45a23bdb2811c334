"""Robot descriptions: one YAML and one MJCF a robot, parsed once into immutable data.

A description says what the robot is (joints, servos, buses, feet, sensors), how its simulated
twin behaves (`plant`, `noise`), and how it walks (`walking`, validated by the controller that
reads it). Units are SI; keys carry a unit suffix where SI would be unhandy (`_ms`, `_us`).
"""

from collections.abc import Collection
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, PositiveFloat, PositiveInt, model_validator

from hil.errors import DescriptionError
from hil.interface import SIDES
from hil.joint_gains import GainSet, kind_of, set_for
from hil.twin import Noise, Plant, Supply
from hil.validation import Config

Vector3 = tuple[float, float, float]


class Joint(Config):
    """One actuated joint, named as in the MJCF."""

    name: str
    range: tuple[float, float]
    """[rad]"""
    velocity_limit: PositiveFloat
    """[rad/s]"""
    torque_limit: PositiveFloat
    """[N·m]"""
    servo: str | None = None
    """Dynamixel model; none for a joint that takes torques, or while nobody knows it yet: such a
    robot walks in MuJoCo, and no bus is opened."""
    bus: str | None = None
    id: int | None = Field(default=None, ge=0, le=252)
    direction: Literal[-1, 1] = 1
    """Sign of the servo's position against the joint's."""
    mode: Literal["position", "current_position", "current"] = "position"
    """How the servo makes torque: by duty, by current from the position error, by current."""
    stiffness: float = Field(default=0.0, ge=0)
    """Default kp [N·m/rad]."""
    damping: float = Field(default=0.0, ge=0)
    """Default kd [N·m·s/rad]."""


class Bus(Config):
    """One servo bus on its own USB adapter."""

    port: str | None = None
    """Port of the real robot, named by id; none until it is known."""
    baud: PositiveInt
    latency_timer_ms: PositiveInt = 1


class Board(Config):
    """One sensor board on its own serial port."""

    kind: Literal["foot", "imu"]
    port: str | None = None
    baud: PositiveInt = 921600
    rate_hz: PositiveInt
    delay_us: int = Field(default=0, ge=0)
    """From acquisition to the frame's first byte, by the sensor's data sheet."""


class Foot(Config):
    """One foot: a box sole with four load-cell corners."""

    body: str
    """MJCF body of the foot."""
    sole: str
    """MJCF geom of the box sole."""
    toe: str | None = None
    """MJCF geom of a separate toe body, where there is one."""
    ankle: str
    """The joint whose anchor is the ankle point."""
    board: str | None = None


class Imu(Config):
    """The inertial measurement unit, rigid in the root body."""

    board: str
    site: str
    """MJCF site whose frame is the sensor's."""


class Timing(Config):
    """Fixed delays of the robot's computer and adapters; never measured in a dry run."""

    compute_us: PositiveInt
    """From the last byte read to the first byte written."""
    usb_transfer_us: PositiveInt
    """One USB transfer, each way."""


class Start(Config):
    """Pose in which the robot is placed and to which start-up ramps."""

    joints: dict[str, float] = {}
    """[rad], by joint name; joints that are not named start at 0."""
    moving: bool = False
    """Start at the commanded speed, on the left foot, without standing first (torque robots)."""
    lateral_velocity: float = 0.0
    """Initial coronal velocity when moving [m/s]."""
    speed_limit: PositiveFloat | None = None
    """Largest initial sagittal speed when moving [m/s]; a faster walk is sped up to."""


class Sit(Config):
    """Pose in which the robot rests on bent legs, and from which torque goes off."""

    joints: dict[str, float]
    """[rad], by joint name; joints that are not named go to 0."""
    time: PositiveFloat
    """Time of the way down [s]."""


class Safety(Config):
    """Limits of the safety chain."""

    temperature_limit: PositiveFloat = 80.0
    """At which the servos shut themselves down [°C] (Temperature Limit, X-series e-manual)."""
    overload_ends_torque: bool = True
    """Whether a servo may switch itself off for what its firmware calls an overload; if not, the
    supervisor alone judges the load (`torque_share_max`)."""
    torque_share_max: PositiveFloat = 0.6
    """Rms torque over some seconds, as a share of the joint's limit, that stops the robot."""
    voltage_min: PositiveFloat | None = None
    """Least supply at the servos [V]; none is not watched."""
    voltage_patience: PositiveFloat = 0.1
    """How long it may be below that [s]: a step's impact is shorter."""
    goal_speed_max: PositiveFloat = 10.0
    """How fast a position goal may move, in velocity limits of its joint: no glitch of a command
    reaches a servo in one tick. The shipped gait asks for 8.6 of them at touch-down."""


class Defaults(Config):
    """What `stride walk ROBOT` does where the command line is silent."""

    backend: Literal["mujoco", "bus"]
    estimator: Literal["sensors", "truth"]
    pd: Literal["explicit", "implicit"] | None = None
    rate_hz: PositiveInt
    speed: float
    ankle_limit: bool
    stabilizer: bool


class RobotDescription(Config):
    """Everything that is known of a robot before it is switched on."""

    name: str
    model: str
    """MJCF file, relative to the description."""
    actuation: Literal["servo", "torque"]
    root: str
    """MJCF body that carries the free joint."""
    trunk: str | None = None
    """MJCF body that thrown balls are aimed at; none for the root."""
    joints: tuple[Joint, ...] = Field(min_length=1)
    feet: dict[Literal["left", "right"], Foot]
    buses: dict[str, Bus] = {}
    boards: dict[str, Board] = {}
    imu: Imu | None = None
    supply: Supply | None = None
    timing: Timing
    plant: Plant
    noise: Noise
    calibration: str | None = None
    """Calibration file of one real robot, relative to the description."""
    start: Start
    sit: Sit | None = None
    safety: Safety = Safety()
    defaults: Defaults
    gains: dict[int, GainSet] = {}
    """Gain sets of a servo robot by control rate [Hz]; joints not named keep their own gains."""
    walking: dict[str, Any]
    file: str
    """Where the description was read from."""

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names in the order of every array of shape (n,)."""
        return tuple(joint.name for joint in self.joints)

    @cached_property
    def model_path(self) -> Path:
        """Absolute path of the MJCF."""
        return Path(self.file).parent / self.model

    @cached_property
    def start_position(self) -> tuple[float, ...]:
        """Start pose in joint order [rad]."""
        return tuple(self.start.joints.get(name, 0.0) for name in self.joint_names)

    def require_servos(self) -> None:
        """Raises DescriptionError unless every joint says which servo it is, and where."""
        for joint in self.joints:
            missing = [key for key in ("servo", "bus", "id") if getattr(joint, key) is None]
            if missing:
                raise DescriptionError(
                    self.file, f"joints.{joint.name}", f"{', '.join(missing)} not filled in: a bus "
                    "needs them (`stride check --description` lists all that is missing)"
                )  # fmt: skip

    def at_rate(self, rate_hz: int) -> Self:
        """This robot with the joint gains of a control rate [Hz], by `joint_gains.set_for`."""
        if not self.gains:
            return self
        chosen = self.gains[set_for(self.gains, rate_hz)]
        joints = tuple(
            joint.model_copy(update=dict(zip(("stiffness", "damping"), pair, strict=True)))
            if (pair := chosen.get(kind_of(joint.name)))
            else joint
            for joint in self.joints
        )
        return self.model_copy(update={"joints": joints})

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        names = [joint.name for joint in self.joints]
        doubles = sorted({name for name in names if names.count(name) > 1})
        if doubles:
            raise ValueError(f"joint names appear twice: {', '.join(doubles)}")
        if set(self.feet) != set(SIDES):
            raise ValueError(f"feet must be {' and '.join(SIDES)}")
        for joint in self.joints:
            self._check_joint(joint)
        sit = {} if self.sit is None else self.sit.joints
        for key, pose in (("start", self.start.joints), ("sit", sit)):
            strangers = sorted(set(pose) - set(names))
            if strangers:
                raise ValueError(
                    f"{key}.joints names no joint of this robot: {', '.join(strangers)}; "
                    f"valid: {', '.join(names)}"
                )
        for side, foot in self.feet.items():
            if foot.board is not None and foot.board not in self.boards:
                raise ValueError(
                    f"feet.{side}.board {foot.board!r} is not one of boards: "
                    f"{', '.join(self.boards) or '(none)'}"
                )
        if self.imu is not None and self.imu.board not in self.boards:
            raise ValueError(
                f"imu.board {self.imu.board!r} is not one of boards: "
                f"{', '.join(self.boards) or '(none)'}"
            )
        if self.actuation == "servo" and self.supply is None:
            raise ValueError("a servo robot needs a supply")
        self._check_gains(dict.fromkeys(kind_of(name) for name in names))
        return self

    def _check_gains(self, kinds: Collection[str]) -> None:
        if self.gains and self.actuation == "torque":
            raise ValueError("gains: a torque robot has its gains under walking.gains")
        for rate_hz, gains in self.gains.items():
            strangers = sorted(set(gains) - set(kinds))
            if strangers:
                raise ValueError(
                    f"gains.{rate_hz} names no joint of this robot: {', '.join(strangers)}; "
                    f"valid: {', '.join(kinds)}"
                )

    def _check_joint(self, joint: Joint) -> None:
        if not joint.range[0] < joint.range[1]:
            raise ValueError(f"joint {joint.name}: range must rise, got {joint.range}")
        if self.actuation == "torque":
            return
        if joint.bus is not None and joint.bus not in self.buses:
            raise ValueError(
                f"joint {joint.name}: bus {joint.bus!r} is not one of buses: "
                f"{', '.join(self.buses) or '(none)'}"
            )
        twins = [
            other.name for other in self.joints if other.bus == joint.bus and other.id == joint.id
        ]
        if None not in (joint.bus, joint.id) and len(twins) > 1:
            raise ValueError(f"joints {' and '.join(twins)} share id {joint.id} on {joint.bus}")
