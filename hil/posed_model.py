"""A robot's model at recorded poses: where its parts were, by forward kinematics."""

from typing import Any

import mujoco

from hil.description import RobotDescription
from hil.interface import Floats
from hil.trace import Trace


class PosedModel:
    """The robot's own MuJoCo model and its data, which a pose fills."""

    def __init__(self, description: RobotDescription) -> None:
        self.model: Any = mujoco.MjModel.from_xml_path(str(description.model_path))
        self.data: Any = mujoco.MjData(self.model)
        model = self.model
        self._free = int(model.jnt_qposadr[model.body(description.root).jntadr[0]])
        self._angles = [int(model.joint(name).qposadr[0]) for name in description.joint_names]

    def place(
        self, base_position: Floats, base_orientation: Floats, joint_position: Floats
    ) -> None:
        """Base [m], (3,), its quaternion w x y z, (4,), and joint angles [rad], (n,)."""
        data, free = self.data, self._free
        data.qpos[free : free + 3] = base_position
        data.qpos[free + 3 : free + 7] = base_orientation
        data.qpos[self._angles] = joint_position
        mujoco.mj_kinematics(self.model, data)

    def place_tick(self, trace: Trace, tick: int) -> None:
        """As in a recorded tick."""
        self.place(
            trace.base_position[tick], trace.base_orientation[tick], trace.joint_position[tick]
        )
