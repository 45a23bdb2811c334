"""What hangs on one joint of a robot held in the air: inertia and gravity of its links."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats

GRID = 121
"""Angles at which inertia and gravity are tabulated."""


@dataclass(frozen=True, slots=True)
class JointLoad:
    """Inertia and gravity torque of a joint's links by its angle, from the robot's MJCF.

    The root is upright and held, all other joints are rigid in the start pose: the diagonal of
    the mass matrix without the rotor, and the bias force at rest.
    """

    angles: Floats
    """[rad], rising, shape (m,)."""
    inertias: Floats
    """[kg·m²], shape (m,)."""
    gravities: Floats
    """Torque that holds the joint [N·m], shape (m,)."""

    def inertia(self, position: Floats) -> Floats:
        """At some angles [kg·m²]."""
        return np.interp(position, self.angles, self.inertias)

    def gravity(self, position: Floats) -> Floats:
        """Holding torque at some angles [N·m]."""
        return np.interp(position, self.angles, self.gravities)


def joint_load(description: RobotDescription, joint: int) -> JointLoad:
    """Tabulate the load of a joint over its range."""
    model = mujoco.MjModel.from_xml_path(str(description.model_path))
    data = mujoco.MjData(model)
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, n) for n in description.joint_names]
    data.qpos[model.jnt_qposadr[ids]] = description.start_position
    address, dof = model.jnt_qposadr[ids[joint]], model.jnt_dofadr[ids[joint]]
    angles = np.linspace(*description.joints[joint].range, GRID)
    inertias, gravities = np.empty(GRID), np.empty(GRID)
    full = np.zeros((model.nv, model.nv))
    for place, angle in enumerate(angles):
        data.qpos[address] = angle
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, full)
        inertias[place] = full[dof, dof] - model.dof_armature[dof]
        gravities[place] = data.qfrc_bias[dof]
    return JointLoad(angles, inertias, gravities)
