"""Before the first step: the torso moves above the first stance foot, both feet on the ground."""

import math

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.heading_frame import Pair
from controller.walking.servo_config import WeightShiftConfig
from controller.walking.support_force import SoleForce


class WeightShift:
    """Minimum-jerk shift of the torso by `distance` to the left in `time`.

    Starting from a centred stance a small biped falls within two steps: its capture point must
    be near the stance ankle before the other foot lifts.
    """

    def __init__(self, config: WeightShiftConfig) -> None:
        self._config = config
        self._elapsed = 0.0
        self._start: Pair | None = None

    @property
    def finished(self) -> bool:
        """Whether the first step may begin."""
        return self._elapsed >= self._config.time

    def update(self, dt: float, model: RobotModel) -> tuple[Pair, Pair]:
        """Wanted place and velocity of the base, horizontal world axes [m], [m/s]."""
        if self._start is None:
            self._start = (float(model.root_position[0]), float(model.root_position[1]))
        self._elapsed += dt
        time = self._config.time
        u = min(self._elapsed / time, 1.0)
        share = u * u * u * (10.0 + u * (6.0 * u - 15.0))
        speed = 30.0 * u * u * (1.0 - u) ** 2 / time
        x, y = (model.ankles[0] - model.ankles[1])[:2].tolist()
        length = math.hypot(x, y) / self._config.distance
        x, y = x / length, y / length
        start_x, start_y = self._start
        return (start_x + share * x, start_y + share * y), (speed * x, speed * y)

    def ground_reaction(self, model: RobotModel, ankle_height: float) -> list[SoleForce]:
        """What carries the weight below the com, on both feet."""
        across = (model.ankles[0] - model.ankles[1])[:2]
        from_right = (model.com - model.ankles[1])[:2]
        left = min(max(float(from_right @ across / (across @ across)), 0.0), 1.0)
        offset = np.append(from_right - left * across, -ankle_height)
        return [
            SoleForce(foot, model.ankles[foot] + offset, np.array([0.0, 0.0, share * model.weight]))
            for foot, share in enumerate((left, 1.0 - left))
        ]
