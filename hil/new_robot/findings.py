"""What `stride new-robot` found, assumed and left out, as rows of a table."""

from collections import Counter
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from hil.interface import Floats
from hil.joint_gains import kind_of
from hil.new_robot.gait import Fitted, crouch
from hil.new_robot.joints import Drive, JointLines
from hil.new_robot.limbs import Legs
from hil.new_robot.posture import Posture
from hil.new_robot.similar import Scale, pattern_joint
from hil.new_robot.soles import Sole
from hil.new_robot.source import Source

Kind = Literal["found", "assumed", "left out", "to fill in", "look at"]
WEAK = 0.6
"""Joints with less of a similar robot's torque are told: minibiped's rms is 0.3 of it."""
MIRROR = 0.02
"""Legs that differ by more than this share of their length are no mirror images."""
TILT_SHOWN = 0.02
"""Axes tilted by less are straight [rad]."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One row."""

    kind: Kind
    what: str
    says: str


def findings_of(
    source: Source,
    legs: Legs,
    posture: Posture,
    soles: tuple[Sole, Sole],
    joints: tuple[JointLines, ...],
    fit: Fitted,
    scale: Scale,
    drive: Drive,
    sits: bool,
) -> tuple[Finding, ...]:
    """All rows, most important last: what the user has to do."""
    leg = posture.legs[0]
    mass = float(posture.model.body_mass.sum())
    rows = [
        Finding("found", "mass, leg", f"{mass:.3g} kg, {leg.thigh:.3g} + {leg.shank:.3g} m, hips "
                f"{fit.hip_spacing:.3g} m apart, ankle {fit.ankle_height:.3g} m high"),
        Finding("found", "joints", ", ".join(f"{j.source} = {j.name}" for j in joints)),
        Finding("assumed" if soles[0].assumed else "found", "soles", _sole(soles[0], fit)),
        *_geometry(posture),
        *_held(source, posture),
        *(Finding("left out" if "left out" in note else "look at", "file", note)
          for note in source.notes),
    ]  # fmt: skip
    if legs.guessed:
        rows.append(
            Finding("assumed", "forward", "no joint name says left or right: forward is the "
                    "model's x axis")
        )  # fmt: skip
    counts = Counter(key for joint in joints for key in joint.assumed)
    rows += [
        Finding("assumed", key, f"not in the model for {count} of {len(joints)} joints: "
                "minibiped's, scaled by mass and leg")
        for key, count in counts.items()
    ]  # fmt: skip
    rows += _poses(crouch(leg), joints)
    rows += _weak(joints, scale)
    if not sits:
        rows.append(Finding("look at", "sit", "no pose to rest in was found within the ranges"))
    rows.append(Finding("to fill in", "servos", _servos(drive)))
    return tuple(rows)


def _servos(drive: Drive) -> str:
    if drive.servo is None:
        return "servo and id of every joint, before any bus is used; a walk in MuJoCo needs none"
    return f"all are {drive.servo} with ids 1 to 6 and 11 to 16 (assumed): the dry run can begin"


def _sole(sole: Sole, fit: Fitted) -> str:
    x, y, _ = (2e3 * sole.half).tolist()
    size = f"{x:.0f} x {y:.0f} mm, middle {2e3 * fit.ahead:.0f} mm ahead of the ankle"
    return size + (": the feet have no shape that can be read" if sole.assumed else "")


def _geometry(posture: Posture) -> list[Finding]:
    """Where the legs are not those that inverse kinematics solves in closed form."""
    rows = []
    left, right = posture.legs
    gap = max(max(leg.hip_gap, leg.ankle_gap) for leg in posture.legs)
    tilts = {j.role: j.tilt for leg in posture.legs for j in leg.roled.joints}
    tilted = [f"{role} {np.degrees(tilt):.0f}°" for role, tilt in tilts.items()
              if tilt > TILT_SHOWN]  # fmt: skip
    if gap > 1e-4 or tilted:
        text = f"axes pass each other by up to {1e3 * gap:.1f} mm"
        text += f", tilted: {', '.join(tilted)}" if tilted else ""
        rows.append(Finding("look at", "leg axes", f"{text}; the walk corrects for it"))
    mirrored = [
        float(np.linalg.norm(_mirror(left.anchors[role], posture) - right.anchors[role]))
        for role in left.anchors
    ]
    if max(mirrored) > MIRROR * left.length:
        rows.append(
            Finding("look at", "symmetry", f"the legs are no mirror images: "
                    f"{1e3 * max(mirrored):.0f} mm apart; step widths follow the left one")
        )  # fmt: skip
    return rows


def _weak(joints: tuple[JointLines, ...], scale: Scale) -> list[Finding]:
    """Joints of the model with far less torque than the gait's own robot would have."""
    shares = {
        joint.name: joint.torque_limit
        / (pattern_joint(kind_of(joint.name)).torque_limit * scale.torque)
        for joint in joints
    }
    weak = {name: share for name, share in shares.items() if share < WEAK}
    if not weak:
        return []
    worst = min(weak, key=lambda name: weak[name])
    return [
        Finding("look at", "torque", f"{len(weak)} joints have less than {WEAK:g} of the torque of "
                f"a robot similar to minibiped ({worst} {weak[worst]:.2f}): its gait may be too "
                "much for them; --similar gives servos that go with it")
    ]  # fmt: skip


def _mirror(point: Floats, posture: Posture) -> Floats:
    """A point seen in the plane midway between the hips."""
    hips = [leg.anchors["hip_pitch"] for leg in posture.legs]
    return np.array([point[0], hips[0][1] + hips[1][1] - point[1], point[2]])


def _held(source: Source, posture: Posture) -> list[Finding]:
    model = source.model
    driven = {j.joint for leg in posture.legs for j in leg.roled.joints}
    names = [
        model.joint(joint).name
        for joint in range(model.njnt)
        if joint not in driven and model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE
    ]
    if not names:
        return []
    some = ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
    return [Finding("left out", "other joints", f"{len(names)} held as they are: {some}")]


def _poses(angles: dict[str, float], joints: tuple[JointLines, ...]) -> list[Finding]:
    """Joints whose ranges do not let the robot stand as it walks."""
    rows = []
    for joint in joints:
        wanted = angles.get(kind_of(joint.name))
        low, high = joint.range
        if wanted is not None and not low <= wanted <= high:
            rows.append(
                Finding("look at", joint.name, f"the walk stands at {wanted:.2f} rad, outside its "
                        f"range {low:.2f} to {high:.2f}: raise walking.hip_height")
            )  # fmt: skip
    return rows
