"""The push: which acceleration brings the body to its take-off velocity over what is left."""

import numpy as np

from controller.jumping.jump_plan import JumpPlan
from controller.jumping.path import JumpPath
from controller.jumping.stage import Kit
from controller.jumping.whole_body import BodyTask
from hil.interface import Estimate, Floats

LEAST_TIME = 0.06
"""The end of the push is not steered harder than over so long a time [s]: the ground gives way for
about a third of it (MuJoCo's contacts, time constant 0.02 s), and would ring."""


class Thrust:
    """Steers the centre of mass to a velocity v* at a height z*.

        t = 2·(z* − z)/(v_z + v*_z),   a = (v* − v)/t

    At the begin of an undisturbed push from rest this is the constant acceleration v*²/(2 s) of
    a force F = m·(g + v*²/(2 s)); afterwards whatever the push has missed so far is made up for
    in the time that is left. The ground gives m·(a + g), through the centre of mass.
    """

    def __init__(self, path: JumpPath, dt: float) -> None:
        self._velocity, self._height = path.take_off_velocity, float(path.take_off[2])
        self._planned, self._dt = path.acceleration, dt
        self.over = False
        """The body is as high as it should be: it flies."""

    def acceleration(self, com: Floats, velocity: Floats) -> Floats:
        """Of the centre of mass in this tick [m/s²], (3,)."""
        left = self._height - float(com[2])
        mean = max(float(velocity[2] + self._velocity[2]) / 2.0, 0.25 * float(self._velocity[2]))
        time_left = left / mean
        self.over = time_left < 1.0 * self._dt
        missing = self._velocity - velocity - self._planned * time_left
        return np.asarray(self._planned + missing / max(time_left, LEAST_TIME))


class Push:
    """Thrust from the crouch; over at the height of take-off."""

    def __init__(self, kit: Kit, plan: JumpPlan) -> None:
        self._kit = kit
        self._thrust = Thrust(plan.path, kit.dt)
        self.over = False

    def task(self, estimate: Estimate) -> BodyTask:
        """The acceleration that leads to the take-off velocity."""
        robot = self._kit.tasks.body.robot
        acceleration = self._thrust.acceleration(robot.com, robot.com_velocity)
        self.over = self._thrust.over
        self._kit.tasks.bow(self._kit.depth)
        return self._kit.tasks.ground(estimate, acceleration, np.ones(2, dtype=np.bool_))
