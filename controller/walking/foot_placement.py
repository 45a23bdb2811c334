"""Foot placement by the inverted pendulum model (IPM): where the swing foot must land.

Seed 000_bd1305a0ae731442, section 3, after Coros 2010: the foot is set where a pendulum with the
body's speed would come to rest upright over it.
"""

import math

import numpy as np
from pydantic import Field, PositiveFloat

from controller.walking.heading_frame import Pair
from hil.validation import Config

SHORTEST_BLEND = 0.1
"""Phase over which the foot reaches its target when it is taken over late."""


def pendulum_distance(velocity: float, height: float, gain: float, gravity: float) -> float:
    """Step distance d = k·v·√(h/g + v²/(4g²)) [m], signed like the velocity v [m/s].

    `height` h is that of the centre of mass above the stance ankle [m], gain k is 1 for the ideal
    pendulum. A height below zero (a body that has fallen) counts as zero.
    """
    under_root = max(height, 0.0) / gravity + (velocity / (2.0 * gravity)) ** 2
    return gain * velocity * math.sqrt(under_root)


class FootPlacementConfig(Config):
    """Constants of the placement, sagittal and coronal."""

    gain: tuple[PositiveFloat, PositiveFloat]
    """k of the two axes; 1.3 in the author's code."""
    speed_offset: tuple[float, float]
    """Step shortened by this times the commanded speed [m per m/s]."""
    half_width: float
    """Outward offset of the landing point from the pendulum's [m]."""
    limit: PositiveFloat
    """Largest distance from the centre of mass on either axis, as a fraction of the leg."""
    drag_lag: tuple[tuple[float, float], ...] = ()
    """(level [m], lag [s³/m²]) of water: a swing foot that lags behind its target by lag·V³ is sent
    so much further; linear between levels."""
    end_phase: float = Field(gt=0)
    """The foot is on its target from this phase on."""


class FootPlacement:
    """Horizontal target of the swing ankle relative to the whole-body centre of mass.

    d_x = d(v_x) − a_x·V*_x + Δ and d_y = d(v_y) − a_y·V*_y ± w/2, both within ± limit·leg, in
    the heading frame; the sign is that of the swing side. Between the phase φ_0 at which the
    pendulum takes the foot over and the end phase φ_e, the part s = 1 − t² of the way is done,
    target(φ) = (1 − t²)·d + t²·start with t = clip(1 − (φ − φ_0)/(φ_e − φ_0), 0, 1).
    """

    def __init__(self, config: FootPlacementConfig, leg_length: float, gravity: float) -> None:
        self._config = config
        self._gravity = gravity
        self._limit = config.limit * leg_length
        self._lag = tuple(zip(*(config.drag_lag or ((0.0, 0.0),)), strict=True))

    def distance(
        self,
        velocity: Pair,
        height: float,
        wanted: Pair,
        alteration: float,
        outward: float,
    ) -> Pair:
        """Landing point d relative to the centre of mass in the heading frame [m].

        `velocity` and `wanted` are sagittal and coronal speeds [m/s]; `outward` is the coronal
        offset ± w/2 [m], positive to the left.
        """
        config = self._config
        limit = self._limit
        (gain_x, gain_y), (offset_x, offset_y) = config.gain, config.speed_offset
        x = pendulum_distance(velocity[0], height, gain_x, self._gravity)
        y = pendulum_distance(velocity[1], height, gain_y, self._gravity)
        x += alteration - offset_x * wanted[0]
        y += outward - offset_y * wanted[1]
        return min(max(x, -limit), limit), min(max(y, -limit), limit)

    def lead(self, speed: float, level: float, resistance: float) -> float:
        """How much further the foot is sent than it is to land, because drag holds it back [m].

        lag(H)·V³·ρμ/ρ_water for the mean sagittal speed V of the body [m/s]. Drag goes with V²,
        but a faster walk has longer steps too: the third power fits the placements that the
        integral of the speed error finds. `level` is H [m], `resistance` the factor ρμ/ρ_water.
        """
        levels, lags = self._lag
        lag = float(np.interp(level, levels, lags))
        return lag * speed**3 * resistance

    def share(self, phase: float, take_over: float | None) -> float:
        """Part s of the way from the start of the swing to the landing point.

        `take_over` is φ_0, none before it.
        """
        if take_over is None:
            return 0.0
        span = max(self._config.end_phase - take_over, SHORTEST_BLEND)
        t = min(max(1.0 - (phase - take_over) / span, 0.0), 1.0)
        return 1.0 - t * t
