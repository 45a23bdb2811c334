"""Ankle guards: rules that withdraw the virtual force from an ankle that it would tip over.

The first author's stored code for seed 000_bd1305a0ae731442; `ankle_limit` replaces them by one
bound from the measured load. They are kept for comparisons.
"""

import numpy as np

from controller.robot_model import RobotModel
from hil.interface import Floats

PHASES = (0.2, 0.8)
"""The pitch torque acts between these phases only."""
PITCH_RATE = 0.307
"""The pitch torque ends above this angular velocity of the foot, in √(g/L) (1 rad/s human)."""
ROLL_RATE = 0.154
"""The roll torque ends when the foot already rolls its way faster, in √(g/L) (0.5 rad/s)."""
ROLL_LIMIT = 0.031
"""Largest roll torque, in m·g·L (20 N·m of the human)."""


class AnkleGuards:
    """Keeps of a foot's share of the virtual force what its contact allows.

    Pitch acts only while the forefoot is loaded, 0.2 < φ < 0.8 and the foot turns slowly; roll
    only while the forefoot is loaded, up to a limit, and not along with a roll under way.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        rate = float(np.sqrt(robot.gravity / robot.leg_length))
        self._pitch_rate, self._roll_rate = PITCH_RATE * rate, ROLL_RATE * rate
        self._roll_limit = ROLL_LIMIT * robot.weight * robot.leg_length

    def guarded(
        self, torque: Floats, foot: int, forefoot: float, phase: float, heading: Floats
    ) -> Floats:
        """The part of the torque on a foot that is let through [N·m], world axes, shape (3,).

        `foot` is 0 left or 1 right, `forefoot` the load on its front corners and toe [N],
        `heading` the heading frame to world, shape (3, 3).
        """
        if forefoot <= 0.0:
            return np.zeros(3)
        turning = heading.T @ self._robot.foot_twists[foot][:3]
        roll, pitch, _ = (heading.T @ torque).tolist()
        if not PHASES[0] < phase < PHASES[1] or np.linalg.norm(turning) > self._pitch_rate:
            pitch = 0.0
        if turning[0] * np.sign(roll) > self._roll_rate:
            roll = 0.0
        roll = min(max(roll, -self._roll_limit), self._roll_limit)
        kept: Floats = heading[:, 0] * roll + heading[:, 1] * pitch
        return kept
