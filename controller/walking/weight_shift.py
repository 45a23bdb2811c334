"""Before the first step: the torso moves above the first stance foot, both feet on the ground."""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.servo_config import WeightShiftConfig
from hil.interface import Floats


class WeightShift:
    """Minimum-jerk shift of the torso by `distance` to the left in `time`.

    Starting from a centred stance a small biped falls within two steps: its capture point must
    be near the stance ankle before the other foot lifts.
    """

    def __init__(self, config: WeightShiftConfig) -> None:
        self._config = config
        self._elapsed = 0.0
        self._start: Floats | None = None

    @property
    def finished(self) -> bool:
        """Whether the first step may begin."""
        return self._elapsed >= self._config.time

    def update(self, dt: float, model: RobotModel) -> tuple[Floats, Floats]:
        """Wanted place and velocity of the base, horizontal world axes [m], [m/s]."""
        if self._start is None:
            self._start = model.data.xpos[model.root_body][:2].copy()
        self._elapsed += dt
        time = self._config.time
        u = min(self._elapsed / time, 1.0)
        share = u * u * u * (10.0 + u * (6.0 * u - 15.0))
        speed = 30.0 * u * u * (1.0 - u) ** 2 / time
        across = model.ankle_positions[0, :2] - model.ankle_positions[1, :2]
        across = across / np.hypot(*across) * self._config.distance
        return self._start + share * across, speed * across

    def ground_reaction(self, model: RobotModel, ankle_height: float) -> tuple[Floats, Floats]:
        """Points [m] and forces [N] of both feet that carry the weight below the com, (2, 3)."""
        points = model.ankle_positions.copy()
        points[:, 2] -= ankle_height
        across = points[0, :2] - points[1, :2]
        from_right = model.com[:2] - points[1, :2]
        left = float(np.clip(from_right @ across / (across @ across), 0.0, 1.0))
        ahead = from_right - left * across
        points[:, :2] += ahead
        forces = np.zeros((2, 3))
        forces[:, 2] = model.weight * np.array([left, 1.0 - left])
        return points, forces
