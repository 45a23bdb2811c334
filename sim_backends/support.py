"""What holds a simulated robot by its root body: a hand for a while, or a gantry for good."""

import mujoco

from hil.interface import Floats
from sim_backends.model import SUPPORT

HOIST = 0.3
"""How high a robot is lifted that is to move without touching the floor [m]."""


class Support:
    """The weld of the root body to the world: on or off, at the pose that it finds."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, position: Floats, orientation: Floats
    ) -> None:
        """`position`, `orientation`: views of the root body's state, (3,) and (4,)."""
        self._model, self._data = model, data
        self._position, self._orientation = position, orientation
        self._weld = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_EQUALITY, SUPPORT)
        self._hoisted = False

    def set(self, supported: bool) -> None:
        """Hold the root body where it is, or let it go; one that hangs stays where it is."""
        if self._hoisted:
            return
        if supported:
            # data of a weld: anchor (3), position (3) and quaternion (4) held, torque scale.
            self._model.eq_data[self._weld, 3:6] = self._position
            self._model.eq_data[self._weld, 6:10] = self._orientation
        self._data.eq_active[self._weld] = supported

    def hoist(self, height: float) -> None:
        """Lift the root body [m] and never let it go."""
        self._position[2] += height
        self.set(True)
        self._hoisted = True
        mujoco.mj_forward(self._model, self._data)
