"""Joint targets of both legs: an upright torso on the stance foot, the swing foot on its path."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.heading_frame import Pair
from controller.walking.leg_chain import LegChain
from controller.walking.leg_kinematics import LegGeometry, Rows, Vector, yaw_rows
from hil.interface import Floats

SPACING = 0.004
"""Distance of the three instants that give velocity and acceleration [s]."""
INSTANTS = (-SPACING, 0.0, SPACING)


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
        hips = model.hip_positions - model.root_position
        self._hips: list[list[float]] = hips.tolist()
        chains = [LegChain(model, leg) for leg in range(len(hips))]
        exact = all(chain.exact for chain in chains)
        self._solvers = [LegGeometry.of(model).solve] * 2 if exact else [c.solve for c in chains]
        self._fixed_hips: Floats | None = None if exact else hips
        """Hip centres in the base where joints move what they are read from [m], (2, 3)."""
        self.ankle_height = float(model.ankles[0][2] - model.corner_positions[0, 0, 2])
        """Ankle point above the sole [m]."""
        self._stance_drop = hip_height - self.ankle_height
        self._ankles: list[list[Vector]] = [[], []]
        self._feet: list[Rows] = [(), ()]

    def support(
        self, leg: int, ankle: Pair, velocity: Pair, lead: float, heading: float, yaw: float
    ) -> None:
        """Let a leg carry the torso.

        `ankle` is the place of its ankle against the base origin [m] and `velocity` that of the
        base [m/s], both horizontal, world axes; `yaw` is the heading of the foot [rad].
        """
        c, s = math.cos(heading), math.sin(heading)
        (x, y), (u, v), (hip_x, hip_y, _) = ankle, velocity, self._hips[leg]
        ankles = []
        for instant in INSTANTS:
            time = lead + instant
            seen_x, seen_y = x - time * u, y - time * v
            ankles.append(
                (c * seen_x + s * seen_y - hip_x, c * seen_y - s * seen_x - hip_y,
                 -self._stance_drop)
            )  # fmt: skip
        self._ankles[leg] = ankles
        self._feet[leg] = yaw_rows(yaw - heading)

    def swing(
        self, leg: int, points: Sequence[Vector], velocity: Vector, lead: float, yaw: float
    ) -> None:
        """Let a leg reach for world points of its ankle [m], one per instant.

        `velocity` is that of the base [m/s]; `yaw` the heading of the foot [rad].
        """
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = self._model.root_rotation.tolist()
        hip_x, hip_y, hip_z = self._hip(leg)
        u, v, w = velocity
        ankles = []
        for (x, y, z), instant in zip(points, INSTANTS, strict=True):
            time = lead + instant
            x, y, z = x - hip_x - time * u, y - hip_y - time * v, z - hip_z - time * w
            ankles.append(
                (x * xx + y * yx + z * zx, x * xy + y * yy + z * zy, x * xz + y * yz + z * zz)
            )
        self._ankles[leg] = ankles
        c, s = math.cos(yaw), math.sin(yaw)
        self._feet[leg] = (
            (xx * c + yx * s, yx * c - xx * s, zx),
            (xy * c + yy * s, yy * c - xy * s, zy),
            (xz * c + yz * s, yz * c - xz * s, zz),
        )

    def _hip(self, leg: int) -> list[float]:
        """Hip centre in the world [m]."""
        model = self._model
        hip = model.hips[leg]
        if self._fixed_hips is not None:
            hip = model.root_position + model.root_rotation @ self._fixed_hips[leg]
        place: list[float] = hip.tolist()
        return place

    def solve(self) -> LegTargets:
        """Joint targets of both legs as they were set."""
        (solve_left, solve_right), (left, right) = self._solvers, self._feet
        angles: list[float] = []
        for to_left, to_right in zip(*self._ankles, strict=True):
            angles += solve_left(to_left, left)
            angles += solve_right(to_right, right)
        before, now, after = np.array(angles).reshape(3, 2, 6)
        velocity = (after - before) / (2.0 * SPACING)
        return LegTargets(now, velocity, (after - 2.0 * now + before) / SPACING**2)
