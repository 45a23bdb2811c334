"""Limit of the drag's impulse: a force held for a whole step must not push a body back.

The drag of a step is that of its beginning. On a light limb at a low rate, or in a very viscous
liquid, its impulse could reverse the motion and add energy.
"""

import numpy as np

from hil.interface import Floats


class ImpulseLimit:
    """Scales the wrench W of each body by min(1, P/(h·WᵀI⁻¹W)), P = −W·twist its power.

    A free body of inertia I gains −h·s·P + ½h²s²·WᵀI⁻¹W of kinetic energy from s·W in a step h:
    the limit is where it has lost the most, half of where it would begin to gain. A body in a
    chain moves less than a free one: for M = Σ JᵀIJ the energy ½h²·QᵀM⁻¹Q of the joint forces
    Q = Σ JᵀW is at most the sum of those of the free bodies, so the whole robot never gains.
    """

    def __init__(self, mass: Floats, inertia: Floats, step: float) -> None:
        """`mass` [kg], (k,), principal `inertia` [kg·m²], (k, 3), `step` h [s]."""
        self._inverse = np.empty((len(mass), 2, 3))
        self._inverse[:, 0] = step / mass[:, None]
        self._inverse[:, 1] = step / inertia

    def apply(self, wrench: Floats, twist: Floats, rows: slice | np.ndarray) -> None:
        """Scale wrenches, shape (k, 2, 3), in place; both are in the bodies' principal axes."""
        count = len(wrench)
        flat, moved = wrench.reshape(count, 6), self._inverse[rows].reshape(count, 6)
        power = -np.add.reduce(flat * twist.reshape(count, 6), axis=1)
        gained = np.add.reduce(flat * flat * moved, axis=1)
        scale = power / np.maximum(gained, 1e-300)
        np.minimum(scale, 1.0, out=scale)
        flat *= scale[:, None]
