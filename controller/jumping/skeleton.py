"""A robot's hinges as the ball joints of an animator's skeleton."""

from dataclasses import dataclass

import numpy as np

from controller.jumping.posture import Posture
from controller.robot_model import RobotModel
from controller.walking.rotations import about_axis
from hil.interface import Floats

TOGETHER = 1e-9
"""Anchors closer than this are one [m]."""


@dataclass(frozen=True, slots=True)
class Bone:
    """One ball joint and what it carries: hinges that meet in one point, as one rotation."""

    name: str
    """MJCF body that follows the last of its hinges."""
    parent: int
    """Index among the bones, always smaller than its own; −1 for the root."""
    anchor: Floats
    """Where it turns, in root axes in the zero posture [m], shape (3,)."""
    axes: Floats
    """Of its hinges, in that posture, shape (h, 3)."""
    joints: tuple[int, ...]
    """Indices of its hinges in description order."""
    end: Floats
    """Where a bone without children ends, as the anchor [m]."""


class Skeleton:
    """Bones from the root down, parents before children; the root bone turns with the root body.

    In the zero posture every bone's axes are the root's. A bone with hinges w_i at angles q_i is
    turned against its parent by Π R(w_i, q_i).
    """

    def __init__(self, robot: RobotModel) -> None:
        robot.place_at_zero()
        self._robot = robot
        self._origin = robot.root_position.copy()
        name = robot.model.body(robot.root_body).name
        none = np.zeros((0, 3))
        self.bones = [Bone(name, -1, np.zeros(3), none, (), np.zeros(3))]
        self._add_children(robot.root_body, 0)

    def rotations(self, posture: Posture) -> list[Floats]:
        """Every bone against its parent, the root against the world, each of shape (3, 3)."""
        self._robot.set_state(posture)
        turned = [self._robot.root_rotation.copy()]
        for bone in self.bones[1:]:
            rotation = np.eye(3)
            for axis, joint in zip(bone.axes, bone.joints, strict=True):
                angle = float(posture.joint_position[joint])
                rotation = rotation @ about_axis(axis.tolist(), angle)
            turned.append(rotation)
        return turned

    def children(self, bone: int) -> list[int]:
        """Bones that hang on one."""
        return [place for place, each in enumerate(self.bones) if each.parent == bone]

    def _add_children(self, body: int, parent: int) -> None:
        model = self._robot.model
        for child in np.flatnonzero(model.body_parentid == body).tolist():
            if child != body:
                self._add(child, parent)

    def _add(self, body: int, parent: int) -> None:
        """Bones of a body, one for each anchor; hinges at the parent's anchor join the parent."""
        model, data = self._robot.model, self._robot.data
        name = model.body(body).name
        # A bone that carries more than this body must not take on this body's hinges.
        mergeable = parent > 0 and np.sum(model.body_parentid == model.body_parentid[body]) == 1
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        for hinge in range(first, first + count):
            listed = np.flatnonzero(self._robot.joint_ids == hinge).tolist()
            anchor, axis = data.xanchor[hinge] - self._origin, data.xaxis[hinge].copy()
            above = self.bones[parent]
            if mergeable and np.linalg.norm(anchor - above.anchor) < TOGETHER:
                axes = np.vstack((above.axes, axis))
                joints = (*above.joints, *listed)
                bone = Bone(name, above.parent, above.anchor, axes, joints, self._end(body))
                self.bones[parent] = bone
            else:
                bone = Bone(name, parent, anchor, axis[None], tuple(listed), self._end(body))
                self.bones.append(bone)
                parent, mergeable = len(self.bones) - 1, True
        self._add_children(body, parent)

    def _end(self, body: int) -> Floats:
        """Centre of the body's first geom, or of its mass."""
        model, data = self._robot.model, self._robot.data
        geoms = np.flatnonzero(model.geom_bodyid == body)
        centre = data.geom_xpos[geoms[0]] if len(geoms) else data.xipos[body]
        end: Floats = centre - self._origin
        return end
