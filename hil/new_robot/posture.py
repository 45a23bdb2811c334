"""The zero pose that the walk counts from: straight legs, hips above knees above ankles."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.interface import Floats
from hil.new_robot.limbs import Legs
from hil.new_robot.roles import LEG_JOINTS, RoledLeg
from hil.new_robot.source import Source, free_joint

HIP = ("hip_yaw", "hip_roll", "hip_pitch")
ANKLE = ("ankle_pitch", "ankle_roll")
PITCHES = ("hip_pitch", "knee", "ankle_pitch")
ROUNDS = 4
"""Straightening moves points along their axes a little: it is done again until they rest."""


@dataclass(frozen=True, slots=True)
class PosedLeg:
    """One leg in the zero pose, world axes: x forward, y left, z up."""

    roled: RoledLeg
    anchors: dict[str, Floats]
    """A point on the axis of each joint, by role [m]: the one nearest to the centre of its hip,
    knee or ankle."""
    axes: dict[str, Floats]
    """Unit axis of each joint, by role, turned to the robot's +x, +y or +z."""
    offsets: dict[str, float]
    """What the model's own angle, with its sign, is in this pose [rad]: walk's angle + offset."""
    hip_gap: float
    """How far the hip axes pass by each other's common point [m]."""
    ankle_gap: float
    """The same of the ankle axes [m]."""

    @property
    def thigh(self) -> float:
        """Hip centre to knee [m]."""
        return float(np.linalg.norm(self.anchors["hip_pitch"] - self.anchors["knee"]))

    @property
    def shank(self) -> float:
        """Knee to ankle [m]."""
        return float(np.linalg.norm(self.anchors["knee"] - self.anchors["ankle_roll"]))

    @property
    def length(self) -> float:
        """Hip to knee to ankle [m]."""
        return self.thigh + self.shank


@dataclass(frozen=True, slots=True)
class Posture:
    """A model standing in the zero pose."""

    model: mujoco.MjModel
    data: mujoco.MjData
    """Its kinematics in that pose, turned so that x is forward."""
    legs: tuple[PosedLeg, PosedLeg]
    """Left, right."""


def zero_pose(source: Source, legs: Legs, roled: tuple[RoledLeg, RoledLeg]) -> Posture:
    """Straighten both legs by their three pitch joints; all other joints stay where they are in
    the model's own pose. Feet keep their level of that pose.
    """
    model = source.model
    data = mujoco.MjData(model)
    _turn(model, data, legs.heading)
    angles: list[dict[str, float]] = [dict.fromkeys(LEG_JOINTS, 0.0) for _ in roled]
    start = data.qpos.copy()
    for _ in range(ROUNDS):
        data.qpos[:] = start
        for leg, angle in zip(roled, angles, strict=True):
            for joint in leg.joints:
                data.qpos[model.jnt_qposadr[joint.joint]] += joint.sign * angle[joint.role]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        points = [_points(leg, data) for leg in roled]
        for (anchors, _, _), angle in zip(points, angles, strict=True):
            thigh, shank = _lean(anchors, "hip_pitch", "knee"), _lean(anchors, "knee", "ankle_roll")
            for role, change in zip(PITCHES, (-thigh, thigh - shank, shank), strict=True):
                angle[role] += change
    posed = [_posed(model, leg, data) for leg in roled]
    return Posture(model, data, (posed[0], posed[1]))


def _turn(model: mujoco.MjModel, data: mujoco.MjData, heading: float) -> None:
    """Turn the free root so that the robot looks along x."""
    root = free_joint(model)
    turn, old = np.zeros(4), np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, np.array([0.0, 0.0, 1.0]), -heading)
    place = slice(model.jnt_qposadr[root] + 3, model.jnt_qposadr[root] + 7)
    old[:] = data.qpos[place]
    turned = np.zeros(4)
    mujoco.mju_mulQuat(turned, turn, old)
    data.qpos[place] = turned


def _points(
    leg: RoledLeg, data: mujoco.MjData
) -> tuple[dict[str, Floats], dict[str, Floats], tuple[float, float]]:
    """Anchors by role, axes by role, gaps of hip and ankle."""
    axes = {joint.role: joint.sign * data.xaxis[joint.joint] for joint in leg.joints}
    lines = {joint.role: np.array(data.xanchor[joint.joint]) for joint in leg.joints}
    anchors: dict[str, Floats] = {}
    gaps = []
    centres = []
    for group in (HIP, ANKLE):
        centre = _nearest([lines[r] for r in group], [axes[r] for r in group])
        centres.append(centre)
        for role in group:
            anchors[role] = _project(centre, lines[role], axes[role])
        gaps.append(max(float(np.linalg.norm(anchors[role] - centre)) for role in group))
    anchors["knee"] = _project((centres[0] + centres[1]) / 2, lines["knee"], axes["knee"])
    return anchors, axes, (gaps[0], gaps[1])


def _nearest(points: list[Floats], axes: list[Floats]) -> Floats:
    """The point with the least squared distance to lines: Σ(I − aaᵀ)·x = Σ(I − aaᵀ)·p."""
    across = [np.eye(3) - np.outer(axis, axis) for axis in axes]
    total = sum(p @ a for p, a in zip(points, across, strict=True))
    value: Floats = np.linalg.lstsq(np.sum(across, axis=0), total, rcond=None)[0].astype(float)
    return value


def _project(point: Floats, on: Floats, axis: Floats) -> Floats:
    value: Floats = on + axis * float((point - on) @ axis)
    return value


def _lean(anchors: dict[str, Floats], top: str, bottom: str) -> float:
    """Angle about y by which a link is turned from hanging straight down [rad]."""
    x, _, z = anchors[bottom] - anchors[top]
    return float(np.arctan2(-x, -z))


def _posed(model: mujoco.MjModel, leg: RoledLeg, data: mujoco.MjData) -> PosedLeg:
    anchors, axes, gaps = _points(leg, data)
    offsets = {
        joint.role: joint.sign * float(data.qpos[model.jnt_qposadr[joint.joint]])
        for joint in leg.joints
    }
    return PosedLeg(leg, anchors, axes, offsets, *gaps)
