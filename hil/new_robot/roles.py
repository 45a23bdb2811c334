"""Which joint of a leg is which: by axis and by order from the hip to the foot."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.errors import InputError
from hil.interface import Floats
from hil.new_robot.limbs import Legs, Limb
from hil.new_robot.source import Source

LEG_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
"""What a leg must have for the shipped walk, from the hip to the foot."""
_KINDS = ("roll", "pitch", "yaw")
"""Of an axis along x, y, z of the robot."""
TILT = 0.8
"""Least cosine between a joint's axis and the one that it is taken for: 37 degrees."""


@dataclass(frozen=True, slots=True)
class LegJoint:
    """One joint of a leg in the role it plays."""

    role: str
    joint: int
    """MuJoCo joint id."""
    sign: int
    """+1 if the model's axis points along the robot's +x, +y or +z, -1 against it."""
    tilt: float
    """Angle between the two [rad]."""


@dataclass(frozen=True, slots=True)
class RoledLeg:
    """The six joints of a leg in the order of the model, and those that are to be held."""

    joints: tuple[LegJoint, ...]
    held: tuple[int, ...]
    """MuJoCo ids of joints beyond the six, such as toes."""

    def by_role(self, role: str) -> LegJoint:
        """The joint of a role."""
        return next(joint for joint in self.joints if joint.role == role)


def roles_of(source: Source, legs: Legs) -> tuple[RoledLeg, RoledLeg]:
    """Roles of the joints of both legs, left and right. Raises InputError, naming what each leg
    has and what it lacks.
    """
    model = source.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    c, s = np.cos(legs.heading), np.sin(legs.heading)
    to_robot = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    axes = data.xaxis @ to_robot.T
    return (
        _roles(source, "left", legs.left, axes),
        _roles(source, "right", legs.right, axes),
    )


def _roles(source: Source, side: str, limb: Limb, axes: Floats) -> RoledLeg:
    model = source.model
    names = ", ".join(limb.names(model))
    where = f"{source.file}: the {side} leg ({names})"
    kinds, signs, tilts = zip(*(_kind(where, model, j, axes[j]) for j in limb.joints), strict=True)
    pitches = [place for place, kind in enumerate(kinds) if kind == "pitch"]
    if len(pitches) < 3:
        raise InputError(
            f"{where} has {len(pitches)} pitch joints: the walk needs hip, knee and ankle pitch"
        )
    knee = pitches[1]
    found: dict[str, int] = {"hip_pitch": pitches[0], "knee": knee, "ankle_pitch": pitches[2]}
    held = list(pitches[3:])
    for place, kind in enumerate(kinds):
        if kind == "pitch":
            continue
        role = f"hip_{kind}" if place < knee else f"ankle_{kind}"
        if role not in LEG_JOINTS or role in found:
            name = model.joint(limb.joints[place]).name
            raise InputError(
                f"{where} has another {kind} joint, {name}, {'above' if place < knee else 'below'} "
                "the knee: only hip yaw, roll, pitch, knee, ankle pitch, roll can be driven"
            )
        found[role] = place
    missing = [role for role in LEG_JOINTS if role not in found]
    if missing:
        raise InputError(
            f"{where} has no {' and no '.join(missing)}: the walk needs six joints a leg "
            f"({', '.join(LEG_JOINTS)})"
        )
    roles = {place: role for role, place in found.items()}
    joints = tuple(
        LegJoint(roles[place], limb.joints[place], signs[place], tilts[place])
        for place in sorted(roles)
    )
    return RoledLeg(joints, tuple(limb.joints[place] for place in held))


def _kind(where: str, model: mujoco.MjModel, joint: int, axis: Floats) -> tuple[str, int, float]:
    """Roll, pitch or yaw; the sign; the tilt [rad]."""
    place = int(np.abs(axis).argmax())
    cosine = float(abs(axis[place]))
    if cosine < TILT:
        raise InputError(
            f"{where}: the axis of {model.joint(joint).name} lies between the robot's axes "
            f"({np.round(axis, 2).tolist()}): is it roll, pitch or yaw?"
        )
    return _KINDS[place], int(np.sign(axis[place])), float(np.arccos(min(cosine, 1.0)))
