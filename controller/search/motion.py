"""Where head and hands are during a walk, from its recorded poses."""

from typing import Any

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Floats

HEAD = "head"
LEG_OF_THE_WEIGHTS_M = 0.93
"""Leg length of the character for which the objective's lengths are given [m]."""


class MotionMeter:
    """Forward kinematics of the end effectors that seed 000_bd1305a0ae731442, section 4.1, judges.

    The head is the body of that name; a robot without one is judged by its trunk. Hands are
    judged where the robot's description says where they are kept (`walking.hands`).
    """

    def __init__(self, description: RobotDescription) -> None:
        """Raises DescriptionError for a model that lacks what the description names."""
        self._robot = RobotModel(description)
        model = self._robot.model
        self.scale = self._robot.leg_length / LEG_OF_THE_WEIGHTS_M
        """Leg length over that of the seeds' character."""
        head = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, HEAD)
        trunk = description.trunk or description.root
        self._head = head if head >= 0 else model.body(trunk).id
        hands: dict[str, Any] = description.walking.get("hands") or {}
        self._hands = [
            (model.body(f"{side}_forearm").id, hands["point"] * mirror, hands["target"] * mirror)
            for side, mirror in (("left", np.ones(3)), ("right", np.array([1.0, -1.0, 1.0])))
            if hands
        ]

    def measure(
        self, base_position: Floats, base_orientation: Floats, joints: Floats, heading: Floats
    ) -> dict[str, Floats]:
        """Columns over T ticks, from columns (T, 3), (T, 4), (T, n), (T,) of a walk.

        Of the head: `head_height` above the ground, `head_forward` and `head_left` of the root
        body in the heading frame [m], `head_pitch` and `head_roll` [rad], each of shape (T,).
        Of the hands, where there are any: `hands`, distance from their target places in the frame
        of the root body [m], shape (T, 2).
        """
        head = np.empty((len(heading), 5))
        hands = np.empty((len(heading), len(self._hands)))
        robot, data = self._robot, self._robot.data
        cos, sin = np.cos(heading), np.sin(heading)
        for tick in range(len(heading)):
            data.qpos[:3], data.qpos[3:7] = base_position[tick], base_orientation[tick]
            data.qpos[robot.qpos_addresses] = joints[tick]
            mujoco.mj_kinematics(robot.model, data)
            head[tick] = self._head_pose(float(cos[tick]), float(sin[tick]))
            hands[tick] = self._hand_distances()
        names = ("head_height", "head_forward", "head_left", "head_pitch", "head_roll")
        columns: dict[str, Floats] = dict(zip(names, head.T, strict=True))
        return columns | ({"hands": hands} if self._hands else {})

    def _head_pose(self, cos: float, sin: float) -> tuple[float, ...]:
        data = self._robot.data
        x, y, z = data.xpos[self._head].tolist()
        dx, dy = x - self._robot.root_position[0], y - self._robot.root_position[1]
        r = data.xmat[self._head].tolist()
        pitch = np.arcsin(min(1.0, max(-1.0, -r[6])))
        return z, cos * dx + sin * dy, cos * dy - sin * dx, pitch, np.arctan2(r[7], r[8])

    def _hand_distances(self) -> list[float]:
        data, root = self._robot.data, self._robot.root_rotation
        places = [
            (data.xpos[body] + data.xmat[body].reshape(3, 3) @ point) - self._robot.root_position
            for body, point, _ in self._hands
        ]
        targets = (target for *_, target in self._hands)
        return [
            float(np.linalg.norm(place @ root - target))
            for place, target in zip(places, targets, strict=True)
        ]
