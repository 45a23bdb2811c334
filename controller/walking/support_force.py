"""Feed-forward torques of the legs: gravity, and the ground reaction that the pendulum asks for."""

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats


class SupportForce:
    """τ_ff = g(q, q̇) − Σ_feet J_fᵀ·F_f.

    g holds every link's weight (and balances its velocity terms) with the base held; F_f acts on
    the sole of foot f, J_f is the Jacobian of that point of the foot.
    """

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._bias: Floats = np.zeros(model.model.nv)
        self._jacobian: Floats = np.zeros((3, model.model.nv))

    def torques(self, points: Floats, forces: Floats) -> Floats:
        """Joint torques [N·m], shape (n,), for sole points [m] and ground reactions [N], (2, 3)."""
        model, data, bias = self._model.model, self._model.data, self._bias
        mujoco.mj_rne(model, data, 0, bias)
        for body, point, force in zip(self._model.foot_bodies, points, forces, strict=True):
            mujoco.mj_jac(model, data, self._jacobian, None, point, body)
            bias -= force @ self._jacobian
        return bias[self._model.dof_addresses]
