"""Velocity tuning by the centre of pressure: the virtual force of the gait as an ankle ZMP."""

import math
from collections.abc import Sequence

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.bounds import clip
from controller.walking.gait import Gait
from controller.walking.heading_frame import HeadingFrame, Pair
from controller.walking.pendulum_state import PendulumState
from controller.walking.servo_config import BalanceConfig
from controller.walking.support_force import SoleForce

LOADED = 0.3
"""Share of body weight on the stance foot from which its measured cop is used."""


class Balance:
    """Centre of pressure p, and the ground reaction that follows from it.

    p = k_z·(ξ − ξ_ref), ξ_ref = b·e^(ωφT) the steady walk's capture point at phase φ, clipped to
    the ankle limit. The force acts at p + k_c·(p − cop), cop the measured one: stiff ankles
    on a sole that tilts a little would otherwise leave it at an edge. Places and pressures count
    from the pivot, `ahead` of the ankle: the knee is ahead of it, and so carries less.
    """

    def __init__(self, config: BalanceConfig, model: RobotModel, ankle_limit: bool) -> None:
        self._config = config
        self._model = model
        corners = model.corner_positions[0] - model.ankles[0]
        self._corners: list[list[float]] = corners.tolist()
        nearest = np.abs(corners).min(axis=0)
        self._sole: Pair = (float(nearest[0]), float(nearest[1]))
        share = (config.limit_x, config.limit_y) if ankle_limit else (1.0, 1.0)
        self._limit: Pair = (share[0] * self._sole[0], share[1] * self._sole[1])
        self.pressure: Pair = (0.0, 0.0)
        """p from the pivot, heading frame [m]."""
        self.measured: Pair | None = None
        """The measured cop from the pivot, heading frame [m]; None while it is not trusted."""
        self._force_point: Pair = (0.0, 0.0)

    def update(self, state: PendulumState, start: Pair, phase: float) -> None:
        """Choose p for a steady start b of the present step."""
        config, pendulum = self._config, state.pendulum
        growth = math.exp(pendulum.omega * phase * pendulum.period)
        self.pressure = (
            clip(config.gain_x * (state.capture[0] - start[0] * growth), self._limit[0]),
            clip(config.gain_y * (state.capture[1] - start[1] * growth), self._limit[1]),
        )

    def compare(self, corners: Sequence[float], gait: Gait, frame: HeadingFrame) -> None:
        """Move the force's point against the error of the cop of the stance foot's corners [N]."""
        self._force_point = p = self.pressure
        self.measured = None
        load = sum(corners)
        if load < LOADED * gait.weight or gait.time_in_step < self._config.settle_time:
            return
        x, y = frame.to_heading(self._pressure_centre(corners, load, gait.stance))
        self.measured = measured = (x - self._config.ahead, y)
        k, limit = self._config.feedback, self._sole
        self._force_point = (
            clip(p[0] + k * (p[0] - measured[0]), limit[0]),
            clip(p[1] + k * (p[1] - measured[1]), limit[1]),
        )

    def _pressure_centre(self, corners: Sequence[float], load: float, foot: int) -> Pair:
        """The measured cop from the ankle, world x and y [m]."""
        x = y = z = 0.0
        for force, (corner_x, corner_y, corner_z) in zip(corners, self._corners, strict=True):
            share = force / load
            x, y, z = x + share * corner_x, y + share * corner_y, z + share * corner_z
        (xx, xy, xz), (yx, yy, yz), _ = self._model.feet[foot].tolist()
        return xx * x + xy * y + xz * z, yx * x + yy * y + yz * z

    def ground_reaction(
        self, place: Pair, gait: Gait, frame: HeadingFrame, sole_drop: float
    ) -> list[SoleForce]:
        """F = W·((x − p)/h, (y − p_y)/h, 1). A new stance foot takes it over linearly."""
        model, p = self._model, self._force_point
        height = float(model.com[2])
        x, y = frame.to_world(((place[0] - p[0]) / height, (place[1] - p[1]) / height))
        pivot = frame.to_world((p[0] + self._config.ahead, p[1]))
        share = min(gait.time_in_step / self._config.load_transfer_time, 1.0)
        if gait.steps == 0:
            share = 1.0
        force = gait.weight * np.array((x, y, 1.0))
        reactions = [
            SoleForce(
                gait.stance,
                model.ankles[gait.stance] + (*pivot, -sole_drop),
                share * force,
            )
        ]
        if share < 1.0:
            point = model.ankles[gait.swing] - (0.0, 0.0, sole_drop)
            reactions.append(SoleForce(gait.swing, point, (1.0 - share) * force))
        return reactions
