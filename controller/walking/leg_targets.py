"""Joint targets of both legs: an upright torso on the stance foot, the swing foot on its path."""

from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.leg_kinematics import LegGeometry, yaw_rotation
from hil.interface import Floats

SPACING = 0.004
"""Distance of the three instants that give velocity and acceleration [s]."""
INSTANTS = np.array([-SPACING, 0.0, SPACING])


@dataclass(slots=True)
class LegTargets:
    """Joint targets of one tick, arrays of shape (2, 6): legs left, right."""

    position: Floats
    """[rad]"""
    velocity: Floats
    """[rad/s]"""
    acceleration: Floats
    """[rad/s²]"""


class LegPlanner:
    """Solves both legs at three instants around the moment when the command will act.

    A supporting leg carries an upright torso of heading ψ at a fixed hip height, at the measured
    horizontal place above its ankle: height and attitude are stiff, horizontal motion is free.
    A swinging leg reaches for a point in the world from the measured place and attitude of the
    hips, the foot flat in the world.
    """

    def __init__(self, model: RobotModel, hip_height: float) -> None:
        self._model = model
        self._geometry = LegGeometry.of(model)
        hips = model.hip_positions - model.data.xpos[model.root_body]
        self._hips: Floats = hips.copy()
        self.ankle_height = float(model.ankle_positions[0, 2] - model.corner_positions[0, 0, 2])
        """Ankle point above the sole [m]."""
        self._stance_drop = hip_height - self.ankle_height
        self._ankles: Floats = np.zeros((3, 2, 3))
        self._feet: Floats = np.zeros((2, 3, 3))

    def support(
        self, leg: int, ankle: Floats, velocity: Floats, lead: float, heading: float, yaw: float
    ) -> None:
        """Let a leg carry the torso.

        `ankle` is the place of its ankle against the base origin and `velocity` that of the base,
        both horizontal, world axes, shape (2,); `yaw` is the heading of the foot [rad].
        """
        towards_heading = yaw_rotation(-heading)
        seen = ankle - (lead + INSTANTS)[:, None] * velocity
        target = self._ankles[:, leg]
        target[:, :2] = seen @ towards_heading[:2, :2].T - self._hips[leg, :2]
        target[:, 2] = -self._stance_drop
        self._feet[leg] = yaw_rotation(yaw - heading)

    def swing(self, leg: int, points: Floats, velocity: Floats, lead: float, yaw: float) -> None:
        """Let a leg reach for world points of its ankle, shape (3, 3), one per instant.

        `velocity` is that of the base [m/s], shape (3,); `yaw` the heading of the foot [rad].
        """
        rotation = self._model.root_rotation
        hip = self._model.hip_positions[leg]
        seen = points - hip - (lead + INSTANTS)[:, None] * velocity
        np.matmul(seen, rotation, out=self._ankles[:, leg])
        self._feet[leg] = rotation.T @ yaw_rotation(yaw)

    def solve(self) -> LegTargets:
        """Joint targets of both legs as they were set."""
        solve, feet = self._geometry.solve, self._feet.tolist()
        angles = [
            [solve(ankle, foot) for ankle, foot in zip(ankles, feet, strict=True)]
            for ankles in self._ankles.tolist()
        ]
        before, now, after = np.array(angles)
        velocity = (after - before) / (2.0 * SPACING)
        return LegTargets(now, velocity, (after - 2.0 * now + before) / SPACING**2)
