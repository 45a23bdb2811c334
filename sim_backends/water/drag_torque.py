"""What the drag of the liquid does to the joints: the load that a gait search judges."""

import mujoco
import numpy as np

from hil.interface import Floats
from sim_backends.water.hydrodynamics import Hydrodynamics, cross


class DragTorque:
    """Σ_i |Σ_j (P_j − P_i) × F_j| over the limbs, F_j the drag on their elements at P_j.

    P_i is the joint by which limb i hangs on its parent (seed 003_73fecd8ec8927aad, section 6.1).
    With the drag's force F and torque T about a body's centre of mass c that is T + (c − P_i) × F.
    The root body hangs on nothing.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, root: int, water: Hydrodynamics
    ) -> None:
        self._rows = np.array(
            [
                row
                for row, body in enumerate(water.bodies)
                if body != root and model.body_jntnum[body]
            ],
            dtype=np.int64,
        )
        self._bodies = water.bodies[self._rows]
        self._joints = model.body_jntadr[self._bodies]
        self._data, self._water = data, water

    def total(self) -> float:
        """Of the last substep [N·m]."""
        data = self._data
        wrench = self._water.wrenches[self._rows]
        arm: Floats = data.xipos[self._bodies] - data.xanchor[self._joints]
        torque = wrench[:, 1] + cross(arm, wrench[:, 0])
        return float(np.sqrt(np.square(torque).sum(axis=1)).sum())
