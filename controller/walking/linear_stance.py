"""Mass, damping and stiffness of a torque robot under its control law, on one foot.

What the closed-form ceiling of gains (`gain_ceiling`) and its check by the whole discrete loop are
made of: seed 000_bd1305a0ae731442, sections 3 and 5.2.
"""

from dataclasses import dataclass, field

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from controller.walking.linear_law import LinearLaw
from controller.walking.pose_tracking import PoseTracking
from controller.walking.rotations import about_z
from controller.walking.torque_config import torque_walking_config
from hil.description import RobotDescription
from hil.interface import Floats
from hil.joint_gains import GainSet, kind_of


@dataclass(slots=True)
class StancePose:
    """A moment of a walk, at rest."""

    base_orientation: Floats
    """Base to world, (w, x, y, z)."""
    joint_position: Floats
    """[rad], shape (n,)."""
    heading: float
    """[rad]"""
    stance: int
    """The foot that stands: 0 left, 1 right."""
    base_position: Floats = field(init=False, default_factory=lambda: np.zeros(3))
    base_linear_velocity: Floats = field(init=False, default_factory=lambda: np.zeros(3))
    base_angular_velocity: Floats = field(init=False, default_factory=lambda: np.zeros(3))
    joint_velocity: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.joint_velocity = np.zeros_like(self.joint_position)


class LinearStance:
    """M·ÿ = −D·ẏ − K·y of small motions y that leave the stance foot where it is.

    With N the null space of the stance foot's Jacobian, q = N·y: M = Nᵀ·M_q·N, D = Nᵀ·G(kd)·N and
    K = Nᵀ·G(kp)·N, G the linearised law (`LinearLaw`) with all of the root balance on the stance
    hip. A foot in the air instead (`welded` false) leaves N = 1. The virtual force and the limit
    of the ankle's torque are left out: they take torque away or are weak (h·30/s at most).
    """

    def __init__(self, description: RobotDescription) -> None:
        """Raises DescriptionError for a walking section that does not fit."""
        config = torque_walking_config(description)
        self._robot = robot = RobotModel(description)
        self._groups = groups = JointGroups(description, robot)
        self.rows = (*map(kind_of, groups.names), "root")
        """The joint whose gains each row of the law has, sides left out."""
        unit: GainSet = dict.fromkeys(self.rows, (1.0, 1.0))
        self._tracking = PoseTracking(robot, groups, config, unit)
        self._scales = self._tracking.stiffness.copy()
        trunk = groups.parent == robot.root_body
        self._hips = groups.legs("hip")
        trunk[self._hips] = False
        self._law = LinearLaw(robot, groups, self._tracking, np.flatnonzero(trunk))
        self._free = np.eye(robot.model.nv)
        self._stance = 0
        self.mass = self._free
        """M, shape (m, m)."""

    def place(self, pose: StancePose, *, welded: bool = True) -> None:
        """Linearise there; matrices of an earlier pose are no longer valid."""
        robot = self._robot
        robot.set_state(pose)
        self._tracking.set_frames(about_z(pose.heading), {})
        self._stance = pose.stance
        self._free = standing_on(robot, pose.stance) if welded else np.eye(robot.model.nv)
        self.mass = self._free.T @ mass_matrix(robot) @ self._free

    def matrix(self, gains: Floats) -> Floats:
        """Nᵀ·G·N for gains of every row of the law [N·m/rad or N·m·s/rad], (rows,); (m, m)."""
        hips = (int(self._hips[self._stance]), int(self._hips[1 - self._stance]))
        scaled = (self._scales * gains[:, None])[:, None, :]
        law = self._law.matrix(scaled, hips, (1.0, 0.0))
        reduced: Floats = self._free.T @ law @ self._free
        return reduced


def mass_matrix(robot: RobotModel) -> Floats:
    """M_q of the state that the model is in, shape (nv, nv)."""
    mass = np.zeros((robot.model.nv, robot.model.nv))
    mujoco.mj_makeM(robot.model, robot.data)
    mujoco.mj_fullM(robot.model, robot.data, mass)
    return mass


def standing_on(robot: RobotModel, foot: int) -> Floats:
    """Motions that leave a foot where it is, orthonormal, shape (nv, nv − 6)."""
    jacobian = np.zeros((6, robot.model.nv))
    body = int(robot.foot_bodies[foot])
    mujoco.mj_jacBody(robot.model, robot.data, jacobian[:3], jacobian[3:], body)
    _, _, directions = np.linalg.svd(jacobian)
    return np.ascontiguousarray(directions[6:].T)
