"""Feed-forward torques of the legs: gravity, and the ground reaction that the pendulum asks for."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats


@dataclass(slots=True)
class SoleForce:
    """A ground reaction on one foot, world axes."""

    foot: int
    """0 left, 1 right."""
    point: Floats
    """On the sole [m], shape (3,)."""
    force: Floats
    """[N], shape (3,)."""


class SupportForce:
    """τ_ff = g(q, q̇) − Σ_feet J_fᵀ·F_f.

    g holds every link's weight (and balances its velocity terms) with the base held; F_f acts on
    the sole of foot f, J_f is the Jacobian of that point of the foot.
    """

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._bodies = model.foot_bodies.tolist()
        self._bias: Floats = np.zeros(model.model.nv)
        self._jacobian: Floats = np.zeros((3, model.model.nv))

    def torques(self, reactions: Sequence[SoleForce]) -> Floats:
        """Joint torques [N·m], shape (n,); a foot that is not named carries nothing."""
        model, data, bias = self._model.model, self._model.data, self._bias
        mujoco.mj_rne(model, data, 0, bias)
        for reaction in reactions:
            body = self._bodies[reaction.foot]
            mujoco.mj_jac(model, data, self._jacobian, None, reaction.point, body)
            bias -= reaction.force @ self._jacobian
        return bias[self._model.dof_addresses]
