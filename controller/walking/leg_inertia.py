"""Torque that a swinging leg's motion takes."""

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats, Ints


class LegInertia:
    """M·q̈ of one leg: M the joint-space inertia with the torso held.

    Rotors included: their reflected inertia is most of a small leg's. Off the diagonal, knee and
    hip pitch push each other by a fifth of it.
    """

    def __init__(self, model: RobotModel, legs: Ints) -> None:
        """`legs` are the joints of each leg in the description's order, shape (2, 6)."""
        self._model = model
        self._dofs = model.dof_addresses[legs]
        self._blocks = [np.ix_(dofs, dofs) for dofs in self._dofs]
        self._mass: Floats = np.zeros((model.model.nv, model.model.nv))

    def torque(self, leg: int, acceleration: Floats) -> Floats:
        """[N·m] for joint accelerations [rad/s²], (6,), in the model's present state."""
        torque: Floats = self._matrix()[self._blocks[leg]] @ acceleration
        return torque

    def at_rest(self, position: Floats) -> list[float]:
        """Inertia at each joint of a leg in a pose of all joints [rad], (n,) [kg·m²], six."""
        model = self._model
        model.data.qpos[model.qpos_addresses] = position
        mujoco.mj_kinematics(model.model, model.data)
        mujoco.mj_comPos(model.model, model.data)
        diagonal: list[float] = np.diag(self._matrix())[self._dofs[0]].tolist()
        return diagonal

    def _matrix(self) -> Floats:
        model, data = self._model.model, self._model.data
        mujoco.mj_crb(model, data)
        mujoco.mj_fullM(model, data, self._mass)
        return self._mass
