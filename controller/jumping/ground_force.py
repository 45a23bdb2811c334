"""What the ground gives the feet: a wanted wrench spread over the corners that carry."""

import numpy as np

from hil.interface import Bools, Floats

MOMENT_LENGTH = 0.5
"""A moment error counts as the force error that makes it on such a lever, in leg lengths: a long
one, so that a moment that cannot be had does not cost force."""
SLACK = 1e-4
"""Price of force against error: small, so that only what cannot be reached is given up."""


class GroundForce:
    """Corner forces f_i whose sum and moment about the centre of mass are as wanted.

        minimise |S (G f − w)|² + ε |f|²,   f_i,z ≥ 0,   |f_i,xy| ≤ μ f_i,z

    G stacks [1; (p_i − c)×] of the corners p_i, S weighs moments by a length. The minimum without
    the bounds is f = Gᵀ(S²)(…)⁻¹ w, one 6 × 6 system; a corner that would have to pull is left out
    and the rest solved again, so that no quadratic program is needed. A wrench whose centre of
    pressure lies outside the feet loses part of its moment, hardly of its force. Friction is
    cut off at the cone.
    """

    def __init__(self, weight: float, leg_length: float, friction: float) -> None:
        """`weight` [N], `leg_length` [m], coefficient of `friction` that may be used."""
        self._friction = friction
        self._scale = np.ones(6)
        self._scale[3:] = 1.0 / (MOMENT_LENGTH * leg_length)
        self._weight = weight

    def spread(self, wrench: Floats, levers: Floats, bearing: Bools) -> Floats:
        """Corner forces [N], (k, 3), of corners at `levers` from the centre of mass (k, 3) [m].

        `wrench`: force [N] and moment [N·m], (6,). Corners that do not bear, (k,), get nothing.
        """
        forces = np.zeros(levers.shape)
        active = bearing.copy()
        target = self._scale * wrench
        for _ in range(len(levers)):
            if not active.any():
                break
            grasp = self._grasp(levers[active])
            square = grasp @ grasp.T
            square.flat[::7] += SLACK
            found = (grasp.T @ np.linalg.solve(square, target)).reshape(-1, 3)
            forces[:] = 0.0
            forces[active] = found
            pulling = active & (forces[:, 2] < 0.0)
            if not pulling.any():
                break
            active &= ~pulling
            forces[pulling] = 0.0
        return self._inside_cone(forces)

    def _grasp(self, levers: Floats) -> Floats:
        """S·G, shape (6, 3k)."""
        count = len(levers)
        grasp = np.zeros((6, count, 3))
        grasp[0, :, 0] = grasp[1, :, 1] = grasp[2, :, 2] = 1.0
        x, y, z = levers.T
        grasp[3, :, 1], grasp[3, :, 2] = -z, y
        grasp[4, :, 0], grasp[4, :, 2] = z, -x
        grasp[5, :, 0], grasp[5, :, 1] = -y, x
        return self._scale[:, None] * grasp.reshape(6, 3 * count)

    def _inside_cone(self, forces: Floats) -> Floats:
        np.maximum(forces[:, 2], 0.0, out=forces[:, 2])
        across = np.hypot(forces[:, 0], forces[:, 1])
        limit = self._friction * forces[:, 2]
        too_much = across > limit
        if too_much.any():
            forces[too_much, :2] *= (limit[too_much] / across[too_much])[:, None]
        return forces
