"""Inertia and friction of each swinging joint, learnt from how its servo lags."""

from collections.abc import Sequence

import numpy as np
from pydantic import Field, PositiveFloat

from hil.interface import Floats
from hil.validation import Config

LONGEST = 512
"""Ticks of a swing that are kept."""
FRICTION_SPEED = 0.3
"""Friction grows linearly up to this speed [rad/s]: targets that tremble must not shake it."""
PRIOR_ACCELERATION = 40.0
"""[rad/s²]"""
USABLE = 0.9
"""Share of the stall torque above which a servo no longer does what it is told."""


class LearnedLoadConfig(Config):
    """How much is believed of a swing."""

    memory: PositiveFloat
    """Swings of a leg count for so many swings."""
    prior: float = Field(ge=0)
    """The model counts as much as so many ticks at PRIOR_ACCELERATION."""
    inertia_bound: float = Field(ge=0)
    """Largest deviation from the model's inertia [kg·m²]."""
    friction_bound: float = Field(ge=0)
    """Largest friction [N·m]."""


class LearnedLoad:
    """ΔJ and F of the joints of both legs, by least squares over the ticks of their swings.

    A servo that is told target q*, velocity v* and feed-forward τ drives with
    K·(q* − q) + D·(v* − q̇) + τ. All of it but what gravity and the model's inertia take moves the
    rest of the rotor and overcomes friction:

        K·(q* − q) + D·(v* − q̇) + ΔJ₀·a* + F₀·s(v*)  =  ΔJ·a* + F·s(v*)

    with the ΔJ₀, F₀ that were already fed forward, and s(v) = clip(v/v_F, ±1). A rotor is a large
    part of what a small leg swings, and from servo to servo it is not what the data sheet lets
    guess. Targets belong to a moment `lead` after their tick, so those of some ticks ago are
    compared. Ticks in which a servo saturates teach nothing.
    """

    def __init__(
        self,
        config: LearnedLoadConfig,
        stiffness: Sequence[float],
        damping: Sequence[float],
        stall: Sequence[float],
        ticks_late: float,
        dt: float,
    ) -> None:
        """K, D and stall torque of a leg's n joints; `ticks_late`: a target's lead in ticks."""
        n = len(stiffness)
        self._config = config
        self._stiffness, self._damping = np.array(stiffness), np.array(damping)
        self._usable = USABLE * np.array(stall)
        self._late, self._dt = ticks_late, dt
        self._leg, self._rows = 0, 0
        self._kept = np.zeros((LONGEST, 5, n))
        # Of each leg: Σ a², Σ a·s, Σ s², Σ a·y, Σ s·y.
        self._sums = np.zeros((2, 5, n))
        self.inertia: Floats = np.zeros((2, n))
        """ΔJ [kg·m²]: legs left, right."""
        self.friction: Floats = np.zeros((2, n))
        """F [N·m]"""

    def torque(self, leg: int, velocity: Floats, acceleration: Floats) -> Floats:
        """ΔJ·a* + F·s(v*) [N·m], (n,)."""
        torque: Floats = self.inertia[leg] * acceleration
        torque += self.friction[leg] * _sign(velocity)
        return torque

    def begin(self, leg: int) -> None:
        """A leg lifts off; what was seen of the swing before it is learnt from."""
        if self._rows > 4 + self._late:
            self._learn()
        self._leg, self._rows = leg, 0

    def add(
        self, measured: Floats, position: Floats, velocity: Floats, acceleration: Floats,
        torque: Floats,
    ) -> None:  # fmt: skip
        """One tick of the swing, (n,) each: joints now, and what was just told to the servos."""
        if self._rows < LONGEST:
            row = self._kept[self._rows]
            row[0], row[1], row[2], row[3], row[4] = (
                measured, position, velocity, acceleration, torque,
            )  # fmt: skip
            self._rows += 1

    def _learn(self) -> None:
        leg, config, rows = self._leg, self._config, self._rows
        whole = int(self._late)
        share = self._late - whole
        told = (1.0 - share) * self._kept[1 : rows - whole, 1:]
        told += share * self._kept[: rows - whole - 1, 1:]
        error = told[:, 0] - self._kept[1 + whole : rows, 0]
        rate = np.diff(error, axis=0) / self._dt
        told, error = 0.5 * (told[1:] + told[:-1]), 0.5 * (error[1:] + error[:-1])
        _, v, a, torque = told.transpose(1, 0, 2)
        sign = _sign(v)
        extra = self._stiffness * error + self._damping * rate
        known = np.abs(extra + torque + self._damping * (v - rate)) < self._usable
        y = extra + self.inertia[leg] * a + self.friction[leg] * sign
        a, sign, y = a * known, sign * known, y * known
        sums = self._sums[leg]
        sums *= 1.0 - 1.0 / config.memory
        pairs = ((a, a), (a, sign), (sign, sign), (a, y), (sign, y))
        sums += [(left * right).sum(axis=0) for left, right in pairs]
        aa, mixed, ss, ay, sy = sums
        aa, ss = aa + config.prior * PRIOR_ACCELERATION**2, ss + config.prior
        determinant = aa * ss - mixed * mixed
        inertia = (ss * ay - mixed * sy) / determinant
        friction = (aa * sy - mixed * ay) / determinant
        bound = config.inertia_bound
        self.inertia[leg] = np.clip(inertia, -bound, bound)
        self.friction[leg] = np.clip(friction, 0.0, config.friction_bound)


def _sign(velocity: Floats) -> Floats:
    """s(v): the direction of motion, continuous."""
    return np.clip(velocity / FRICTION_SPEED, -1.0, 1.0)
