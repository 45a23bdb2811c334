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
        self.seen: Pair = (0.0, 0.0)
        """Place as the estimate has it, of its own time [m]."""
        self.place: Pair = (0.0, 0.0)
        """[m]"""
        self.velocity: Pair = (0.0, 0.0)
        """[m/s]"""
        self.capture: Pair = (0.0, 0.0)
        """[m]"""

    def observe(self, ankle: Sequence[float], frame: HeadingFrame, offset: Pair) -> None:
        """Take the model's state.

        `ankle` is the stance ankle [m]; `offset` is added to the place, heading frame [m]: where
        the pivot is, and what the com is off, as its motion and steps of the wrong length tell.
        """
        model, pendulum = self._model, self.pendulum
        com_x, com_y, height = model.com.tolist()
        pendulum.omega = math.sqrt(model.gravity / height)
        u, v, _ = model.com_velocity.tolist()
        self.velocity = frame.to_heading((u, v))
        x, y = frame.to_heading((com_x - ankle[0], com_y - ankle[1]))
        u, v = self.velocity
        self.seen = (x, y)
        self.place = (x + self._lead * u + offset[0], y + self._lead * v + offset[1])
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
