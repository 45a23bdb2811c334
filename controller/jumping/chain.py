"""A single chain of hinges from the root of a robot to one of its feet."""

from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.rotations import about_axis
from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.interface import Floats, Ints

SPREAD = 0.35
"""Distance of a leg's tip points from its ankle, as a share of the leg. Points that far apart let
a descent turn the foot as readily as it moves it; the foot's own corners are too close."""
CROSS = np.array(((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)))
"""Directions of those points, level where the foot is."""


@dataclass(frozen=True, slots=True)
class JointChain:
    """Hinges in a row, each turning all that follows; all vectors in root axes, at angles 0.

    The tip of a chain of k hinges at angles q is T₁·T₂···T_k·p with
    T_i(x) = c_i + R(w_i, q_i)·(x − c_i), anchors c_i and axes w_i of the zero posture.
    """

    joints: Ints
    """Indices in description order, shape (k,)."""
    anchors: Floats
    """A point of each axis [m], shape (k, 3)."""
    axes: Floats
    """Unit vectors, shape (k, 3)."""
    lower: Floats
    """Least angles [rad], shape (k,)."""
    upper: Floats
    """Largest angles [rad], shape (k,)."""
    tip: Floats
    """Points that the last hinge carries [m], shape (p, 3)."""

    def placed(self, angles: Floats) -> tuple[Floats, Floats, Floats]:
        """Anchors (k, 3), axes (k, 3) and tip (p, 3) at angles [rad], shape (k,)."""
        anchors, axes = np.empty_like(self.anchors), np.empty_like(self.axes)
        rotation, shift = np.eye(3), np.zeros(3)
        for hinge, angle in enumerate(angles.tolist()):
            anchors[hinge] = rotation @ self.anchors[hinge] + shift
            axes[hinge] = rotation @ self.axes[hinge]
            rotation = rotation @ about_axis(self.axes[hinge].tolist(), angle)
            shift = anchors[hinge] - rotation @ self.anchors[hinge]
        return anchors, axes, self.tip @ rotation.T + shift

    def points(self, angles: Floats) -> Floats:
        """The tip at angles [rad] of shape (k,), in root axes [m], shape (p, 3)."""
        return self.placed(angles)[2]


def cross_matrix(vector: Floats) -> Floats:
    """The matrix S with S·p = vector × p, shape (3, 3)."""
    x, y, z = vector.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def leg_chain(robot: RobotModel, description: RobotDescription, foot: int) -> JointChain:
    """The hinges from the root to foot 0 (left) or 1 (right); four points around the ankle as tip.

    The points are rigid with the foot: where they are, the foot is flat at its place.

    Limits are the description's. Raises DescriptionError for a joint on the way that the
    description does not list. Leaves the model in its zero posture.
    """
    robot.place_at_zero()
    model, data = robot.model, robot.data
    hinges: list[int] = []
    body = int(robot.foot_bodies[foot])
    while body != robot.root_body:
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        hinges[:0] = range(first, first + count)
        body = int(model.body_parentid[body])
    joints = np.array([_listed(robot, description, hinge) for hinge in hinges])
    limits = np.array([description.joints[joint].range for joint in joints])
    # The zero posture has the root upright; only its place is to be taken away.
    origin = robot.root_position
    anchors = data.xanchor[hinges] - origin
    return JointChain(
        joints=joints,
        anchors=anchors,
        axes=data.xaxis[hinges].copy(),
        lower=limits[:, 0],
        upper=limits[:, 1],
        tip=anchors[-1] + SPREAD * robot.leg_length * CROSS,
    )


def _listed(robot: RobotModel, description: RobotDescription, hinge: int) -> int:
    found = np.flatnonzero(robot.joint_ids == hinge)
    if len(found) != 1:
        name = robot.model.joint(hinge).name
        raise DescriptionError(
            description.file, "joints", f"{name!r} is in a leg of the model but not listed"
        )
    return int(found[0])
