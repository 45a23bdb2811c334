"""The controller's own model of the robot: kinematics, masses and gravity of an estimated state.

It holds an MjModel and MjData of its own, never those of a simulated plant, and only ever sees
what an estimator says. Every quantity belongs to the state of the last `set_state`.
"""

from typing import Protocol

import mujoco
import numpy as np

from controller.selection import selection
from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.interface import SIDES, Floats, Ints

CORNER_SIGNS = np.array([[1, 1, -1], [1, -1, -1], [-1, 1, -1], [-1, -1, -1]], dtype=np.float64)
"""Lower corners of a sole box in half sizes: front_left, front_right, rear_left, rear_right."""

FootPair = tuple[Floats, ...]
"""One array a foot, left and right."""


class BodyState(Protocol):
    """The part of an estimate, or of ground truth, that places the model."""

    base_position: Floats
    base_orientation: Floats
    base_linear_velocity: Floats
    base_angular_velocity: Floats
    joint_position: Floats
    joint_velocity: Floats


class RobotModel:
    """Forward kinematics and mass properties of the described robot.

    Attributes of a state are views of MuJoCo's data: copy what must survive `set_state`.
    Feet are ordered left, right. World axes, metres, radians, seconds.
    """

    def __init__(self, description: RobotDescription) -> None:
        self.model = mujoco.MjModel.from_xml_path(str(description.model_path))
        self.data = mujoco.MjData(self.model)
        self._file = description.file
        self.root_body = self._id(mujoco.mjtObj.mjOBJ_BODY, description.root, "root")
        root_joint = self.model.body_jntadr[self.root_body]
        if root_joint < 0 or self.model.jnt_type[root_joint] != mujoco.mjtJoint.mjJNT_FREE:
            raise DescriptionError(self._file, "root", f"{description.root!r} has no free joint")
        self.base_qpos = int(self.model.jnt_qposadr[root_joint])
        self.base_dof = int(self.model.jnt_dofadr[root_joint])
        self.joint_ids = self._joint_ids(description.joint_names, "joints")
        """MuJoCo joint of every described joint, shape (n,)."""
        self.qpos_addresses: Ints = self.model.jnt_qposadr[self.joint_ids].astype(np.int64)
        """Where each joint is in qpos, shape (n,)."""
        self.dof_addresses: Ints = self.model.jnt_dofadr[self.joint_ids].astype(np.int64)
        """Where each joint is in qvel, shape (n,)."""
        feet = [description.feet[side] for side in SIDES]  # type: ignore[index]
        self.foot_bodies = self._ids(mujoco.mjtObj.mjOBJ_BODY, [f.body for f in feet], "body")
        """Foot bodies, shape (2,)."""
        self.sole_geoms = self._ids(mujoco.mjtObj.mjOBJ_GEOM, [f.sole for f in feet], "sole")
        """Box soles, shape (2,)."""
        self.corner_offsets: Floats = CORNER_SIGNS * self.model.geom_size[self.sole_geoms][:, None]
        """Lower corners of the soles in the frames of their boxes [m], shape (2, 4, 3)."""
        self._ankles = self._joint_ids([f.ankle for f in feet], "feet.*.ankle")
        self._knees = self._joint_ids([f"{side}_knee" for side in SIDES], "joints")
        self._hips = self._joint_ids([f"{side}_hip_pitch" for side in SIDES], "joints")
        self._joint_range = selection(self.joint_ids)
        self._joint_qpos = selection(self.qpos_addresses)
        self._joint_qvel = selection(self.dof_addresses)
        self._view_data()
        self.gravity = float(-self.model.opt.gravity[2])
        """[m/s²]"""
        self.mass = float(self.model.body_subtreemass[self.root_body])
        """[kg]"""
        self.weight = self.mass * self.gravity
        """[N]"""
        self.place_at_zero()
        hip, knee, ankle = (points[0].copy() for points in self.leg_points())
        self.thigh_length = float(np.linalg.norm(hip - knee))
        """Hip centre to knee axis [m]."""
        self.shank_length = float(np.linalg.norm(knee - ankle))
        """Knee axis to ankle point [m]."""
        self.leg_length = self.thigh_length + self.shank_length
        """Hip centre to ankle point of a straight leg [m]."""
        bend = np.arctan2(hip[0] - knee[0], hip[2] - knee[2])
        bend -= np.arctan2(knee[0] - ankle[0], knee[2] - ankle[2])
        self.knee_offset = float(bend)
        """Knee angle at which thigh and shank lie on one line [rad]."""

    def _view_data(self) -> None:
        """Views of MuJoCo's arrays: they follow every state, and cost nothing in a tick."""
        data, dof, qpos = self.data, self.base_dof, self.base_qpos
        self._base = (data.qpos[qpos : qpos + 3], data.qpos[qpos + 3 : qpos + 7])
        self._base_rates = (data.qvel[dof : dof + 3], data.qvel[dof + 3 : dof + 6])
        self._qpos, self._qvel, self._axes = data.qpos, data.qvel, data.xaxis
        self.com: Floats = data.subtree_com[self.root_body]
        """Centre of mass of the whole body [m], shape (3,)."""
        self.com_velocity: Floats = data.subtree_linvel[self.root_body]
        """Velocity of the centre of mass [m/s], shape (3,)."""
        self.root_position: Floats = data.xpos[self.root_body]
        """Origin of the root body [m], shape (3,)."""
        self.root_rotation: Floats = data.xmat[self.root_body].reshape(3, 3)
        """Rotation matrix of the root body, base to world, shape (3, 3)."""
        self.angular_velocities: Floats = data.cvel[:, :3]
        """World angular velocity of every body [rad/s], shape (bodies, 3)."""
        self.ankles: FootPair = tuple(data.xanchor[joint] for joint in self._ankles)
        """Ankle point of each foot [m], each of shape (3,)."""
        self.hips: FootPair = tuple(data.xanchor[joint] for joint in self._hips)
        """Hip centre of each leg [m], each of shape (3,)."""
        self.feet: FootPair = tuple(data.xmat[body].reshape(3, 3) for body in self.foot_bodies)
        """Rotation matrix of each foot body, foot to world, each of shape (3, 3)."""
        self.foot_twists: FootPair = tuple(data.cvel[body] for body in self.foot_bodies)
        """Angular velocity [rad/s] and the velocity of the foot's point at `com` [m/s], (6,)."""
        self.soles: FootPair = tuple(data.geom_xpos[geom] for geom in self.sole_geoms)
        """Centre of each sole box [m], each of shape (3,)."""
        self.sole_rotations: FootPair = tuple(
            data.geom_xmat[geom].reshape(3, 3) for geom in self.sole_geoms
        )
        """Rotation matrix of each sole box, box to world, each of shape (3, 3)."""

    def set_state(self, state: BodyState) -> None:
        """Place the model at a state and compute its kinematics."""
        position, orientation = self._base
        position[:], orientation[:] = state.base_position, state.base_orientation
        self._qpos[self._joint_qpos] = state.joint_position
        linear, angular = self._base_rates
        linear[:], angular[:] = state.base_linear_velocity, state.base_angular_velocity
        self._qvel[self._joint_qvel] = state.joint_velocity
        self._kinematics()

    def _kinematics(self) -> None:
        model, data = self.model, self.data
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)

    def place_at_zero(self) -> None:
        """Place the model where its file has it, every joint at 0."""
        self.data.qpos[:] = self.model.qpos0
        self._kinematics()

    @property
    def ankle_positions(self) -> Floats:
        """Ankle points [m], shape (2, 3)."""
        value: Floats = self.data.xanchor[self._ankles]
        return value

    @property
    def hip_positions(self) -> Floats:
        """Hip centres [m], shape (2, 3)."""
        value: Floats = self.data.xanchor[self._hips]
        return value

    @property
    def foot_rotations(self) -> Floats:
        """Rotation matrices of the foot bodies, foot to world, shape (2, 3, 3)."""
        value: Floats = self.data.xmat[self.foot_bodies].reshape(2, 3, 3)
        return value

    @property
    def corner_positions(self) -> Floats:
        """Lower corners of the soles [m], shape (2, 4, 3)."""
        rotations = self.data.geom_xmat[self.sole_geoms].reshape(2, 3, 3)
        centres = self.data.geom_xpos[self.sole_geoms][:, None, :]
        value: Floats = centres + self.corner_offsets @ rotations.transpose(0, 2, 1)
        return value

    @property
    def joint_axes(self) -> Floats:
        """World axes of the joints, in description order, shape (n, 3)."""
        value: Floats = self._axes[self._joint_range]
        return value

    def leg_points(self) -> tuple[Floats, Floats, Floats]:
        """Hips, knees and ankles of both legs [m], each of shape (2, 3)."""
        anchors = self.data.xanchor
        return anchors[self._hips], anchors[self._knees], anchors[self._ankles]

    def _id(self, kind: int, name: str, key: str) -> int:
        found = int(mujoco.mj_name2id(self.model, kind, name))
        if found < 0:
            raise DescriptionError(self._file, key, f"{name!r} is not in the model")
        return found

    def _ids(self, kind: int, names: list[str], key: str) -> Ints:
        return np.array([self._id(kind, name, f"feet.*.{key}") for name in names])

    def _joint_ids(self, names: tuple[str, ...] | list[str], key: str) -> Ints:
        return np.array([self._id(mujoco.mjtObj.mjOBJ_JOINT, name, key) for name in names])
