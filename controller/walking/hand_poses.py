"""Hand poses: arm targets that keep each hand at a constant place relative to the pelvis.

Seed 000_bd1305a0ae731442, section 4: inverse kinematics produces the key poses of the arms from a
constant target of the hands relative to the pelvis, so that their displacement can be judged.
"""

import math

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from controller.walking.key_poses import CurveTable
from controller.walking.rotations import about_y, about_z, yaw_pitch_roll
from hil.interface import Floats
from hil.validation import Config

Vector3 = tuple[float, float, float]

PHASES = 65
"""Points at which the arms are solved; entries of rotations are linear between them."""
KEPT_FROM_STRAIGHT = 0.999
"""Longest reach, as a fraction of the straight arm."""


class HandPosesConfig(Config):
    """Where the left hand is kept; the right one mirrors it."""

    target: Vector3
    """Place of the hand from the pelvis' origin, in the pelvis frame [m]."""
    point: Vector3
    """The hand in the forearm's frame [m]."""
    elbow_direction: Vector3
    """Side of the line from shoulder to hand on which the elbow lies, in the torso's frame."""


class ArmGeometry:
    """One arm in its zero pose, from the model. All in the frames of the bodies [m]."""

    def __init__(self, robot: RobotModel, groups: JointGroups, side: int, hand: Floats) -> None:
        """`hand` is the point of the left forearm's frame; the right one mirrors it."""
        model = robot.model
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        shoulder, elbow = groups.legs("shoulder")[side], groups.legs("elbow")[side]
        centre = data.xanchor[groups.anchor_joint]
        hinge = centre[elbow]
        self.back: Floats = centre[groups.index("back")] - data.xpos[robot.root_body]
        """Back joint from the pelvis."""
        self.shoulder: Floats = centre[shoulder] - centre[groups.index("back")]
        """Shoulder from the back joint, along the torso's axes."""
        self.upper: Floats = hinge - centre[shoulder]
        """From the shoulder to the elbow."""
        tip = data.xpos[groups.child[elbow]] + hand * (1.0, 1.0 - 2.0 * side, 1.0)
        self.fore: Floats = tip - hinge
        """From the elbow to the hand."""


def two_link_arm(
    upper: Floats, fore: Floats, place: Floats, pole: Floats, bend: int
) -> tuple[Floats, float]:
    """Upper arm's orientation, shape (3, 3), and elbow angle q [rad] that bring a hand to a place.

    `upper` is the elbow from the shoulder, `fore` the hand from the elbow at q = 0, both in the
    upper arm's frame, where the elbow turns about z; `place` is the hand from the shoulder and
    `pole` the direction into which the elbow points, both in the torso's frame; `bend` is the
    sign of q. The law of cosines gives the angle δ between the links,
    cos δ = (L² − a² − b²)/(2ab), and q = bend·δ less the angle between them at q = 0.
    """
    a, b = math.hypot(*upper), math.hypot(*fore)
    length = min(float(np.linalg.norm(place)), KEPT_FROM_STRAIGHT * (a + b))
    cosine = (length * length - a * a - b * b) / (2.0 * a * b)
    between = math.atan2(upper[0] * fore[1] - upper[1] * fore[0], upper[:2] @ fore[:2])
    angle = bend * math.acos(min(max(cosine, -1.0), 1.0)) - between
    own = _basis(upper + about_z(angle) @ fore, upper)
    rotation: Floats = _basis(place, pole) @ own.T
    return rotation, angle


def _basis(along: Floats, aside: Floats) -> Floats:
    """Columns: a direction, what of another is orthogonal to it, and their cross product."""
    first = along / np.linalg.norm(along)
    second = aside - (aside @ first) * first
    second /= np.linalg.norm(second)
    return np.stack((first, second, np.cross(first, second)), axis=1)


class HandPoses:
    """Shoulder orientations R_s(φ) in the torso and elbow angles q_e(φ) of both arms.

    With the targets of pelvis, R_y(root), and torso, R_t = R_z·R_y·R_x, of the key poses at the
    phase φ, hand target h and back joint p in the pelvis, and shoulder s from the back joint in
    the torso, the hand lies at R_tᵀ·R_y(root)·(h − p) − s from the shoulder, in torso axes.
    """

    def __init__(
        self,
        config: HandPosesConfig,
        robot: RobotModel,
        groups: JointGroups,
        curves: CurveTable,
        end_phase: float,
    ) -> None:
        """`curves` are those of the key poses, in their order, up to `end_phase`."""
        self._config = config
        self.groups = [(int(groups.legs("shoulder")[s]), int(groups.legs("elbow")[s]))
                       for s in range(2)]  # fmt: skip
        """Shoulder and elbow group of each arm."""
        arms = [ArmGeometry(robot, groups, s, np.array(config.point)) for s in range(2)]
        self._scale = (PHASES - 1) / end_phase
        phases = np.linspace(0.0, end_phase, PHASES)
        self._tables = np.array(
            [[self._pose(arms, stance, curves.at(phase)) for phase in phases] for stance in (0, 1)]
        )
        """By stance foot, phase, arm: nine entries of the shoulder's rotation, elbow angle."""

    def at(self, stance: int, phase: float) -> Floats:
        """Rows left and right: the shoulder's rotation, nine entries, and the elbow angle."""
        place = min(max(phase * self._scale, 0.0), PHASES - 1.000001)
        low = int(place)
        t = place - low
        table = self._tables[stance]
        values: Floats = (1.0 - t) * table[low] + t * table[low + 1]
        return values

    def _pose(self, arms: list[ArmGeometry], stance: int, angles: list[float]) -> Floats:
        root, yaw, pitch, roll = angles[:4]
        sign = 1 - 2 * stance
        torso = np.array(yaw_pitch_roll(sign * yaw, pitch, sign * roll))
        rows = []
        for side, arm in enumerate(arms):
            mirror = np.array((1.0, 1.0 - 2.0 * side, 1.0))
            target = mirror * self._config.target
            place = torso.T @ about_y(root) @ (target - arm.back) - arm.shoulder
            pole = mirror * self._config.elbow_direction
            rotation, elbow = two_link_arm(arm.upper, arm.fore, place, pole, bend=2 * side - 1)
            rows.append(np.append(rotation.ravel(), elbow))
        return np.array(rows)
