"""Hands at the torso of a virtual robot that stands on its own feet: they lean it, and carry none
of its weight."""

import mujoco
import numpy as np

from hil.interface import Floats
from sim_backends.model import named
from sim_backends.virtual.clock import VirtualClock

_STEP_NS = 2_000_000
_TURN, _TURN_DAMPING = 30.0, 1.2
"""Of the torque about the horizontal axes [N·m/rad, N·m·s/rad]."""
_PULL, _PULL_DAMPING = 400.0, 45.0
"""Of the horizontal force [N/m, N·s/m]."""
SWAY = 0.25
"""How far the root body goes, as a share of its height times the tilt: the hips go along."""


class Steering:
    """A torque and a horizontal force on the root body, from springs to where it should be.

    With roll and pitch (φ, θ) of the torso's vertical, wanted (φ*, θ*), place (x, y) and place
    (x₀, y₀) and height h when it began:

        τ = K(φ* − φ, θ* − θ) − Dω,   F = k((x₀, y₀) + ¼h(θ*, −φ*) − (x, y)) − d(ẋ, ẏ)
    """

    def __init__(self, clock: VirtualClock) -> None:
        plant = clock.plant
        body = mujoco.mjtObj.mjOBJ_BODY
        root = named(plant.model, body, plant.description.root, plant.description.model_path)
        self._clock, self._plant = clock, plant
        self._wrench = plant.data.xfrc_applied[root]
        self._active = False
        self._place = np.zeros(3)
        self.goal: Floats = np.zeros(2)
        """Roll and pitch [rad]."""

    def begin(self) -> None:
        """Take hold."""
        if not self._active:
            self._active = True
            self._place = self._plant.truth().base_position.copy()
            self.goal = np.zeros(2)
            self._step()

    def end(self) -> None:
        """Let go."""
        self._active = False
        self._wrench[:] = 0.0

    def _step(self) -> None:
        if not self._active:
            return
        truth = self._plant.truth()
        w, x, y, z = truth.base_orientation
        tilt = np.array([2 * (w * x + y * z), 2 * (w * y - x * z)])
        sway = SWAY * self._place[2] * np.array([self.goal[1], -self.goal[0]])
        error = self._place[:2] + sway - truth.base_position[:2]
        turning = truth.base_angular_velocity[:2]
        self._wrench[3:5] = _TURN * (self.goal - tilt) - _TURN_DAMPING * turning
        self._wrench[:2] = _PULL * error - _PULL_DAMPING * truth.base_linear_velocity[:2]
        self._clock.schedule(self._clock.now_ns() + _STEP_NS, self._step)
