"""How one joint is moved to learn its servo: slow sweeps, steps, and a chirp, around a centre."""

from dataclasses import dataclass

import numpy as np

from hil.description import Joint
from hil.errors import InputError
from hil.interface import Floats

SWEEP_SPEED = 0.4
"""Of the pendulum sweep [rad/s]."""
SWEEP_REACH = 0.6
"""Largest way of the sweep to each side [rad]."""
SWEEPS = 2
"""There and back, so many times."""
STEP_SIZES = (1.0, -1.0, 0.5, -0.7, 0.9, -0.4, 0.6, -1.0, 0.3, -0.6, 0.8, -0.9)
"""Places of the steps, as shares of the largest."""
STEP_REACH = 0.08
"""[rad]"""
STEP_TIME = 0.35
"""[s]"""
CHIRP_TIME = 8.0
"""[s]"""
CHIRP_BAND = (0.5, 8.0)
"""[Hz]"""
CHIRP_REACH = 0.12
"""[rad]"""
CHIRP_SPEED_SHARE = 0.4
"""Largest speed of the chirp, of the joint's limit."""
SETTLE_TIME = 0.5
"""At rest before each part [s]."""
LEAST_REACH = 0.05
"""A joint that cannot move so far to each side is not identified [rad]."""


@dataclass(frozen=True, slots=True)
class Excitation:
    """Goals of one joint, tick by tick."""

    goal: Floats
    """[rad], shape (ticks,)."""
    part: tuple[str, ...]
    """Which test each tick belongs to."""


def make_excitation(joint: Joint, centre: float, rate_hz: int) -> Excitation:
    """Sweep, steps and chirp of a joint around an angle [rad]; raises InputError for no room."""
    room = min(centre - joint.range[0], joint.range[1] - centre)
    if room < LEAST_REACH:
        raise InputError(
            f"joint {joint.name}: the start pose leaves it {room:.3f} rad of its range, and "
            f"identification needs {LEAST_REACH} to each side"
        )
    parts = {
        "sweep": _sweep(joint, centre, rate_hz),
        "step": centre + _steps(min(STEP_REACH, room), rate_hz),
        "chirp": centre + _chirp(min(CHIRP_REACH, room), joint.velocity_limit, rate_hz),
    }
    rest = round(SETTLE_TIME * rate_hz)
    goals: list[Floats] = []
    names: list[str] = []
    for name, goal in parts.items():
        goals += [np.full(rest, goal[0]), goal]
        names += ["rest"] * rest + [name] * goal.size
    return Excitation(np.concatenate(goals), tuple(names))


def _sweep(joint: Joint, centre: float, rate_hz: int) -> Floats:
    """A pendulum swung slowly to both ends: gravity against friction, both ways."""
    low, high = joint.range
    margin = 0.05 * (high - low)
    ends = [
        max(low + margin, centre - SWEEP_REACH),
        min(high - margin, centre + SWEEP_REACH),
    ] * SWEEPS
    way = np.array([centre, *ends, centre])
    times = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(way)) / SWEEP_SPEED)))
    ticks = np.arange(round(times[-1] * rate_hz)) / rate_hz
    goal: Floats = np.interp(ticks, times, way)
    return goal


def _steps(reach: float, rate_hz: int) -> Floats:
    places: Floats = np.repeat(reach * np.array(STEP_SIZES), round(STEP_TIME * rate_hz))
    return places


def _chirp(reach: float, velocity_limit: float, rate_hz: int) -> Floats:
    """A sine whose frequency rises exponentially, slower than a share of the joint's limit."""
    low, high = CHIRP_BAND
    time = np.arange(round(CHIRP_TIME * rate_hz)) / rate_hz
    growth = np.log(high / low) / CHIRP_TIME
    phase = 2 * np.pi * low * (np.exp(growth * time) - 1) / growth
    omega = 2 * np.pi * low * np.exp(growth * time)
    amplitude = np.minimum(reach, CHIRP_SPEED_SHARE * velocity_limit / omega)
    goal: Floats = amplitude * np.sin(phase)
    return goal
