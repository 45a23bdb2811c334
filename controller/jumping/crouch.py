"""The way down to the crouch from which the push begins."""

import numpy as np

from controller.jumping.stage import Kit
from controller.jumping.whole_body import BodyTask
from hil.interface import Estimate, Floats

TRACKING = 3.0
"""Natural frequency with which the centre of mass follows its curve, in √(g/L)."""
BOTH_FEET = np.array([True, True])


class Crouch:
    """Moves the centre of mass to the crouch, on a polynomial of fifth order, feet on the ground.

    Begins on two feet, at any velocity; over when its time is, at the crouch with the velocity
    that was asked for there.
    """

    def __init__(self, kit: Kit, goal: Floats, goal_velocity: Floats, time: float) -> None:
        self._kit, self._time = kit, time
        self._goal, self._goal_velocity = goal, goal_velocity
        self._elapsed = 0.0
        self._curve: Floats | None = None
        self.over = False

    def task(self, estimate: Estimate) -> BodyTask:
        """Track the polynomial."""
        kit, robot = self._kit, self._kit.tasks.body.robot
        if self._curve is None:
            self._curve = quintic(
                robot.com, robot.com_velocity, self._goal, self._goal_velocity, self._time
            )
        self._elapsed += kit.dt
        t = min(self._elapsed, self._time)
        powers = np.array([1.0, t, t**2, t**3, t**4, t**5])
        rates = np.array([0.0, 1.0, 2.0 * t, 3.0 * t**2, 4.0 * t**3, 5.0 * t**4])
        bends = np.array([0.0, 0.0, 2.0, 6.0 * t, 12.0 * t**2, 20.0 * t**3])
        omega = TRACKING * kit.tasks.pace
        acceleration = bends @ self._curve
        acceleration += omega**2 * (powers @ self._curve - robot.com)
        acceleration += 2.0 * omega * (rates @ self._curve - robot.com_velocity)
        self.over = self._elapsed >= self._time
        kit.tasks.bow(kit.depth)
        return kit.tasks.ground(estimate, acceleration, BOTH_FEET)


def quintic(
    start: Floats, start_velocity: Floats, end: Floats, end_velocity: Floats, time: float
) -> Floats:
    """Coefficients, lowest power first, (6, 3), of the curve without acceleration at its ends."""
    t = time
    matrix = np.array(
        [
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
            [1.0, t, t**2, t**3, t**4, t**5],
            [0.0, 1.0, 2 * t, 3 * t**2, 4 * t**3, 5 * t**4],
            [0.0, 0.0, 2.0, 6 * t, 12 * t**2, 20 * t**3],
        ]
    )
    still = np.zeros(3)
    ends = np.array([start, start_velocity, still, end, end_velocity, still])
    return np.linalg.solve(matrix, ends)
