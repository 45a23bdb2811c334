"""Which way is up for a torso whose soles stand flat: from joint angles alone."""

from collections.abc import Mapping

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats


class SoleLevel:
    """The normal of each sole in the axes of the root body.

    A sole that lies flat has its normal along the vertical, so its normal in base axes is the
    vertical as the joints of that leg know it, to be compared with the IMU's.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._model = mujoco.MjModel.from_xml_path(str(description.model_path))
        self._data = mujoco.MjData(self._model)
        self._root = self._model.body(description.root).id
        self._soles = {
            side: self._model.geom(foot.sole).id for side, foot in description.feet.items()
        }
        self._address = {
            name: int(self._model.joint(name).qposadr[0]) for name in description.joint_names
        }

    def up(self, angles: Mapping[str, float]) -> dict[str, Floats]:
        """The vertical in base axes, (3,), by side; joints that are not named are at 0."""
        mujoco.mj_resetData(self._model, self._data)
        for name, angle in angles.items():
            self._data.qpos[self._address[name]] = angle
        mujoco.mj_kinematics(self._model, self._data)
        base = self._data.xmat[self._root].reshape(3, 3)
        return {
            side: base.T @ self._data.geom_xmat[sole].reshape(3, 3)[:, 2]
            for side, sole in self._soles.items()
        }


def lean_of(up: Floats) -> Floats:
    """Roll and pitch of a body that sees the vertical `up` in its own axes [rad], shape (2,).

    Leaning right is a positive roll, leaning forward a positive pitch.
    """
    x, y, z = up
    return np.array([np.arctan2(y, z), -np.arctan2(x, np.hypot(y, z))])
