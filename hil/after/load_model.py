"""The robot's own model as a scale: which torques its joints need for a measured movement."""

import mujoco
import numpy as np

from hil.body_motion import BodyMotion, foot_load
from hil.description import RobotDescription
from hil.interface import Floats


class LoadModel:
    """Inverse dynamics of the robot's MJCF: q̈, feet's loads → joint torques.

    τ = M·q̈ + c − Σ J_Tᵀ·f over the feet, without rotors and friction of the servos, which is what
    is to be found. f is a foot's corner forces along the normal of its sole and its horizontal
    force, both in the middle of its pressure.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._model = model = mujoco.MjModel.from_xml_path(str(description.model_path))
        self._data = mujoco.MjData(model)
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        for servo in (model.dof_armature, model.dof_frictionloss, model.dof_damping):
            servo[:] = 0.0
        root = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, description.root)
        scale = description.plant.mass_scale
        model.body_mass[root] *= scale
        model.body_inertia[root] *= scale
        mujoco.mj_setConst(model, self._data)
        self.mass = float(model.body_mass.sum())
        """[kg]"""
        joints = [self._id(mujoco.mjtObj.mjOBJ_JOINT, name) for name in description.joint_names]
        self._angles, self._dofs = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
        feet = (description.feet["left"], description.feet["right"])
        self._feet = [self._id(mujoco.mjtObj.mjOBJ_BODY, foot.body) for foot in feet]
        self._soles = [self._id(mujoco.mjtObj.mjOBJ_GEOM, foot.sole) for foot in feet]
        self._force = np.zeros(model.nv)

    def _id(self, kind: mujoco.mjtObj, name: str) -> int:
        return int(mujoco.mj_name2id(self._model, kind, name))

    def torques(
        self, motion: BodyMotion, angles: Floats, speeds: Floats, accelerations: Floats
    ) -> Floats:
        """Torques of all joints [N·m], (T, n)."""
        data = self._data
        torques = np.empty_like(angles)
        for tick in range(len(angles)):
            data.qpos[:3], data.qpos[3:7] = motion.position[tick], motion.orientation[tick]
            data.qvel[:3], data.qvel[3:6] = motion.velocity[tick], motion.spin[tick]
            data.qacc[:3], data.qacc[3:6] = motion.acceleration[tick], motion.spin_rate[tick]
            data.qpos[self._angles] = angles[tick]
            data.qvel[self._dofs] = speeds[tick]
            data.qacc[self._dofs] = accelerations[tick]
            mujoco.mj_inverse(self._model, data)
            self._force[:] = 0.0
            for foot in (0, 1):
                self._press(foot, motion.corners[tick, foot], motion.shear[tick, foot])
            torques[tick] = (data.qfrc_inverse - self._force)[self._dofs]
        return torques

    def _press(self, foot: int, corners: Floats, shear: Floats) -> None:
        """Add the generalized force of one foot's loads."""
        model, data, body, sole = self._model, self._data, self._feet[foot], self._soles[foot]
        axes = data.xmat[body].reshape(3, 3)
        force, point = foot_load(corners, shear, axes, data.geom_xpos[sole], model.geom_size[sole])
        mujoco.mj_applyFT(model, data, force, np.zeros(3), point, body, self._force)

    def sole_axes(self, orientations: Floats, angles: Floats) -> Floats:
        """Pitch and roll of both soles against the level floor [rad], (T, 2, 2): foot, axis.

        Positive as turned about y (toes down) and about x (left edge up).
        """
        model, data = self._model, self._data
        leant = np.empty((len(angles), 2, 2))
        data.qpos[:3] = 0.0
        for tick in range(len(angles)):
            data.qpos[3:7], data.qpos[self._angles] = orientations[tick], angles[tick]
            mujoco.mj_kinematics(model, data)
            for foot in (0, 1):
                rises = data.xmat[self._feet[foot]].reshape(3, 3)[2]
                leant[tick, foot] = -rises[0], rises[1]
        return np.arcsin(leant)

    def turning_axes(self) -> Floats:
        """Axis of every joint in the world in the MJCF's own pose, (n, 3)."""
        mujoco.mj_resetData(self._model, self._data)
        mujoco.mj_kinematics(self._model, self._data)
        owners = {int(dof): joint for joint, dof in enumerate(self._model.jnt_dofadr)}
        return np.array([self._data.xaxis[owners[int(dof)]] for dof in self._dofs])
