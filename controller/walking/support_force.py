"""Feed-forward torques of the legs: gravity, and the ground reaction that the pendulum asks for."""

import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats


class SupportForce:
    """τ_ff = g(q) − Σ_feet Jᵀ_f·F_f.

    g(q) holds every link's weight with the base held; F_f acts on the sole of foot f. Joint i of
    that leg with axis a_i and anchor o_i gets −a_i · ((p_f − o_i) × F_f).
    """

    def __init__(self, model: RobotModel, legs: Floats) -> None:
        self._model = model
        self._joints = model.joint_ids[legs]
        self._legs = legs

    def torques(self, points: Floats, forces: Floats) -> Floats:
        """Joint torques [N·m], shape (n,), for sole points [m] and ground reactions [N], (2, 3)."""
        data = self._model.data
        torque = self._model.gravity_torques()
        lever = points[:, None, :] - data.xanchor[self._joints]
        axis = data.xaxis[self._joints]
        force = forces[:, None, :]
        moment = lever[..., [1, 2, 0]] * force[..., [2, 0, 1]]
        moment -= lever[..., [2, 0, 1]] * force[..., [1, 2, 0]]
        torque[self._legs] -= np.einsum("ijk,ijk->ij", axis, moment)
        return torque
