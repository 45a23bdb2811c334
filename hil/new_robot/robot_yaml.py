"""The robot file that is written: what the model says, what is taken from minibiped, and what
only the builder knows.
"""

from dataclasses import dataclass
from typing import Any

import yaml

from hil.joint_gains import kind_of
from hil.new_robot.gait import Fitted, crouch, walking_section
from hil.new_robot.joints import Drive, JointLines
from hil.new_robot.posture import Posture
from hil.new_robot.roles import LEG_JOINTS
from hil.new_robot.similar import Scale, pattern

HEADER = """\
# {name}: written by `stride new-robot {file}` from a model with {mass:.3g} kg and legs of
# {leg:.3g} m. docs/new-robot.md says what to do with it. `stride check --description {name}.yaml`
# lists what is still missing. Lines marked (assumed) are minibiped's, scaled by mass and leg.
name: "{name}"
model: {name}.xml
actuation: servo
root: torso

# One adapter a leg. Ports stay out until they are known: `stride scan` finds them.
buses:
  left_leg: {{baud: 4000000, latency_timer_ms: 1}}
  right_leg: {{baud: 4000000, latency_timer_ms: 1}}

# To fill in for a servo bus: `servo` (a Dynamixel model) and `id`; then `direction`, which
# `stride calibrate joints` finds. A walk in MuJoCo needs none of them. Behind each joint: its name
# in the model, and the model's angle for ours: sign*angle + offset.
joints:
"""

_REST = """
feet:
  left: {{body: left_foot, sole: left_sole, ankle: left_ankle_roll, board: left_foot}}
  right: {{body: right_foot, sole: right_sole, ankle: right_ankle_roll, board: right_foot}}

imu: {{board: imu, site: imu}}

boards:                  # (assumed) docs/foot-board.md
  left_foot: {{kind: foot, baud: 921600, rate_hz: 600}}
  right_foot: {{kind: foot, baud: 921600, rate_hz: 600}}
  imu: {{kind: imu, baud: 921600, rate_hz: 600, delay_us: 2000}}

supply: {{voltage: {voltage:g}, resistance: 0.0}}  # (assumed) what the limits above hold at; no sag

timing:                  # (assumed)
  compute_us: 800
  usb_transfer_us: 125

plant:
  floor_friction: 0.9    # (assumed)

noise:                   # (assumed) forces go with the weight
{noise}
start:                   # hips above the ankles, knees bent as in the walk
  joints:
{start}
{sit}
defaults:
  backend: {backend}
  estimator: sensors
  rate_hz: 300
  speed: {speed:.3g}
  ankle_limit: true
  stabilizer: false

# minibiped's gait, scaled: lengths with the leg, times with its root, {scales}.
# controller/walking/servo_config.py explains the keys.
walking:
{walking}"""

_SIT = """\
sit:                     # centre of mass over the soles; try it on a hoist
  time: {time:.3g}
  joints:
{joints}"""
_NO_SIT = "# sit: no pose found within the ranges; torque off lets the robot fall\n"

FIRST_IDS = {"left": 1, "right": 11}
"""minibiped's ids, which a servo model's lines begin with."""
FORCES = ("corner_force", "corner_zero")
"""Keys of `noise` that go with the robot's weight."""


@dataclass(frozen=True, slots=True)
class RobotFile:
    """What the robot file is made of."""

    name: str
    file: str
    """Of the model that was read."""
    mass: float
    scale: Scale
    posture: Posture
    fit: Fitted
    joints: tuple[JointLines, ...]
    sit: dict[str, float] | None
    """Pitch angles to rest in [rad], by role."""
    drive: Drive

    def text(self) -> str:
        """The YAML."""
        leg = self.posture.legs[0]
        head = HEADER.format(name=self.name, file=self.file, mass=self.mass, leg=leg.length)
        lines = "".join(_joint(joint, self.drive, place) for place, joint in enumerate(self.joints))
        like = pattern()
        noise = {
            key: float(f"{value * (self.scale.mass if key in FORCES else 1.0):.3g}")
            if isinstance(value, float)
            else value
            for key, value in like.noise.model_dump().items()
        }
        walking = walking_section(self.scale, self.fit)
        rest = _REST.format(
            voltage=self.drive.voltage or (like.supply.voltage if like.supply else 12.0),
            noise=_block(noise, 2),
            start=_block(self._pose(crouch(leg)), 4),
            sit=self._sit(like.sit.time if like.sit else 1.0),
            backend="bus" if self.drive.servo else "mujoco        # bus, once servos are filled in",
            speed=like.defaults.speed * self.scale.speed,
            scales=f"x {self.scale.length:.3g} and x {self.scale.time:.3g}",
            walking=_section(walking),
        )
        return head + lines + rest

    def _sit(self, time: float) -> str:
        """`time`: minibiped's [s]."""
        if self.sit is None:
            return _NO_SIT
        joints = _block(self._pose(self.sit), 4)
        return _SIT.format(time=time * self.scale.time, joints=joints)

    def _pose(self, angles: dict[str, float]) -> dict[str, float]:
        """Angles of both legs [rad], within the ranges."""
        return {
            joint.name: round(min(max(angles[role], joint.range[0]), joint.range[1]), 4)
            for joint in self.joints
            for role in [kind_of(joint.name)]
            if role in angles
        }


def _joint(joint: JointLines, drive: Drive, place: int) -> str:
    side = joint.name.split("_", 1)[0]
    low, high = joint.range
    notes = [f"{joint.source} {joint.sign:+d}"]
    if abs(joint.offset) > 1e-4:
        notes[0] += f" {joint.offset:+.4f}"
    number = "null" if drive.servo is None else str(FIRST_IDS[side] + place % len(LEG_JOINTS))
    shown = [key for key in joint.assumed if key != "armature"]
    if shown:
        notes.append(f"(assumed): {', '.join(shown)}")
    return (
        f"  - {{name: {joint.name}, servo: {drive.servo or 'null'}, bus: {side}_leg, "
        f"id: {number}, direction: 1,\n"
        f"     range: [{low:.4g}, {high:.4g}], velocity_limit: {joint.velocity_limit:.3g}, "
        f"torque_limit: {joint.torque_limit:.3g},\n"
        f"     stiffness: {joint.stiffness:.4g}, damping: {joint.damping:.4g}}}"
        f"  # {'; '.join(notes)}\n"
    )


def _block(values: dict[str, Any], indent: int) -> str:
    return "".join(f"{' ' * indent}{key}: {value}\n" for key, value in values.items())


def _section(walking: dict[str, Any]) -> str:
    """One line a group."""
    lines = []
    for key, value in walking.items():
        text = yaml.safe_dump(value, default_flow_style=True, width=1000, sort_keys=False)
        lines.append(f"  {key}: {text.splitlines()[0]}\n")
    return "".join(lines)
