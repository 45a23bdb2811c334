"""Joint groups: the hinges on one body act as one joint that carries a torque vector.

A ball joint is three hinges on one body, a universal joint two. Control laws work on one torque
vector per group, in world axes, acting on the child body; this module maps names to groups and
vectors to hinge torques.
"""

import numpy as np

from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.interface import SIDES, Bools, Floats, Ints

AXIS_SUFFIXES = ("_yaw", "_roll", "_pitch")


def group_name(joint: str) -> str:
    """Name of a hinge's group: `left_hip_roll` belongs to `left_hip`, `left_knee` to itself."""
    for suffix in AXIS_SUFFIXES:
        if joint.endswith(suffix):
            return joint.removesuffix(suffix)
    return joint


class JointGroups:
    """Groups of a robot, in the order of their first hinge, and projection onto hinges.

    A torque vector τ_g on the child of group g gives hinge i the torque axis_i·τ_g; the
    reaction on the parent follows by itself.
    """

    def __init__(self, description: RobotDescription, robot: RobotModel) -> None:
        self._robot = robot
        model = robot.model
        names = [group_name(joint) for joint in description.joint_names]
        self.names: tuple[str, ...] = tuple(dict.fromkeys(names))
        self.of_joint: Ints = np.array([self.names.index(name) for name in names])
        """Group of every joint, shape (n,)."""
        bodies = model.jnt_bodyid[robot.joint_ids]
        first = [names.index(name) for name in self.names]
        self.child: Ints = bodies[first].astype(np.int64)
        """Body moved by each group, shape (groups,)."""
        if np.any(bodies != self.child[self.of_joint]):
            odd = [n for n, b, g in zip(description.joint_names, bodies, self.of_joint, strict=True)
                   if b != self.child[g]]  # fmt: skip
            raise DescriptionError(
                description.file, "joints", f"hinges of one joint on two bodies: {', '.join(odd)}"
            )
        self.parent: Ints = model.body_parentid[self.child].astype(np.int64)
        """Body that each group hangs on, shape (groups,)."""
        self.anchor_joint: Ints = robot.joint_ids[first]
        """MuJoCo joint whose anchor is the group's joint centre, shape (groups,)."""
        self.joints = [np.flatnonzero(self.of_joint == group) for group in range(len(self.names))]
        """Indices of each group's hinges in description order."""

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str) -> int:
        """Index of a group by name."""
        return self.names.index(name)

    def legs(self, kind: str) -> Ints:
        """Groups of one kind, left and right, shape (2,)."""
        return np.array([self.index(f"{side}_{kind}") for side in SIDES])

    def descends(self) -> Bools:
        """Whether group a (row) is moved by group b (column), or is b, shape (groups, groups)."""
        return self.moves(self.child)

    def moves(self, bodies: Ints) -> Bools:
        """Whether a body (row) is moved by a group (column), shape (len(bodies), groups)."""
        parents = self._robot.model.body_parentid
        result = np.zeros((len(bodies), len(self)), dtype=np.bool_)
        for row, start in enumerate(bodies):
            body = int(start)
            while body > 0:
                result[row] |= self.child == body
                body = int(parents[body])
        return result

    def project(self, torques: Floats, axes: Floats) -> Floats:
        """Hinge torques [N·m], shape (n,), of world torque vectors of shape (groups, 3)."""
        hinge: Floats = np.vecdot(axes, torques.take(self.of_joint, axis=0))
        return hinge
