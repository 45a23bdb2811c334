"""One posture of a robot: where its root is and how its joints are bent."""

from dataclasses import dataclass, field

import numpy as np

from controller.estimation.rotation import from_matrix
from controller.robot_model import RobotModel
from controller.walking.rotations import about_y
from hil.description import RobotDescription
from hil.interface import SIDES, Floats

REST = np.zeros(3)
SOFT = 0.15
"""Bend of knees that are not locked [rad]."""


@dataclass(slots=True)
class Posture:
    """A `controller.robot_model.BodyState` at rest: `robot.set_state(posture)` places it."""

    base_position: Floats
    """Origin of the root body in the world [m], shape (3,)."""
    base_orientation: Floats
    """Root to world, (w, x, y, z)."""
    joint_position: Floats
    """[rad], in description order, shape (n,)."""
    base_linear_velocity: Floats = field(default_factory=REST.copy)
    base_angular_velocity: Floats = field(default_factory=REST.copy)
    joint_velocity: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.joint_velocity = np.zeros_like(self.joint_position)


def standing(robot: RobotModel, joints: Floats, lean: float = 0.0) -> Posture:
    """A posture on the ground: the lowest corner of the soles at z = 0, their centre at x = y = 0.

    `joints` [rad], shape (n,); the root is pitched forward by `lean` [rad]. Leaves the model there.
    """
    upright = from_matrix(about_y(lean))
    robot.set_state(Posture(np.zeros(3), upright, joints))
    corners = robot.corner_positions.reshape(-1, 3)
    shift = -corners.mean(axis=0)
    shift[2] = -corners[:, 2].min()
    posture = Posture(shift, upright, joints)
    robot.set_state(posture)
    return posture


def with_soft_knees(robot: RobotModel, description: RobotDescription, joints: Floats) -> Floats:
    """Joint angles [rad], shape (n,), with straighter knees bent to `SOFT`, the soles as before.

    A hip over a locked knee cannot go down by turning one joint at a time.
    """
    soft, names = joints.copy(), description.joint_names
    for side in SIDES:
        hip, knee, ankle = (
            names.index(f"{side}_{kind}") for kind in ("hip_pitch", "knee", "ankle_pitch")
        )
        more = max(0.0, robot.knee_offset + SOFT - float(joints[knee]))
        soft[[hip, knee, ankle]] += (-0.5 * more, more, -0.5 * more)
    return soft
