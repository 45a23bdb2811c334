"""The robot as a pendulum on its stance ankle, sagittal and lateral."""

import math
from collections.abc import Sequence

from controller.robot_model import RobotModel
from controller.walking.heading_frame import HeadingFrame, Pair
from controller.walking.pendulum import Pendulum


class PendulumState:
    """Place x, velocity v and capture point ξ = x + v/ω of the com, from the stance ankle.

    All in the heading frame and for the moment when the command will act: x ← x + lead·v.
    """

    def __init__(self, model: RobotModel, period: float, lead: float) -> None:
        self._model = model
        self._lead = lead
        self.pendulum = Pendulum(1.0, period)
        """With ω of the present com height."""
        self.place: Pair = (0.0, 0.0)
        """[m]"""
        self.velocity: Pair = (0.0, 0.0)
        """[m/s]"""
        self.capture: Pair = (0.0, 0.0)
        """[m]"""

    def observe(self, ankle: Sequence[float], frame: HeadingFrame, offset: float) -> None:
        """Take the model's state.

        `ankle` is the stance ankle [m]; `offset` is added to the sagittal place [m]: what
        the com seems to be off, as steps of the wrong length tell.
        """
        model, pendulum = self._model, self.pendulum
        com_x, com_y, height = model.com.tolist()
        pendulum.omega = math.sqrt(model.gravity / height)
        u, v, _ = model.com_velocity.tolist()
        self.velocity = frame.to_heading((u, v))
        x, y = frame.to_heading((com_x - ankle[0], com_y - ankle[1]))
        u, v = self.velocity
        self.place = (x + self._lead * u + offset, y + self._lead * v)
        self.capture = (
            self.place[0] + u / pendulum.omega,
            self.place[1] + v / pendulum.omega,
        )

    def steady_start(self, speed: Pair, sway: float) -> Pair:
        """Capture point at the start of a step of the steady walk [m].

        `speed` is the wanted one [m/s], `sway` the step width, signed towards the swing side.
        """
        pendulum = self.pendulum
        return pendulum.steady_start(speed[0], 0.0), pendulum.steady_start(speed[1], sway)
