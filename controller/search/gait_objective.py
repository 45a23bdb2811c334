"""The objective of the gait search: what makes a walk good, as named terms.

Seed 003_73fecd8ec8927aad, section 6.1, equation 2:

    f_eval = Σ_{t<k} (η·f_energ + β·f_drag + γ·f_acc)·(1 + 0.1·R_ipm) + f_speed + f_balance

Here f_energ and the others are means over the ticks, each over its value in the walk of the start,
so that weights compare them on any robot. Further terms are further entries of `TERMS`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from hil.interface import Floats

ALTERATION_WEIGHT = 0.1
ALTERATION_LIMIT = 0.09
"""Δ at which R_ipm is 1, for a leg of 0.93 m [m]."""
LEG_OF_THE_LIMIT_M = 0.93
"""Leg length of the character for which that limit is given [m]."""
SPEED_WEIGHT = 1e10
BALANCE_WEIGHT = 1e15
REFERENCE_SHARE = 0.25
"""Of the reference poses in the acceleration."""
PUSHED_WEIGHT = 100.0
"""Of the walk that is missing when pushes grow until the robot falls (ours)."""


@dataclass(frozen=True, slots=True)
class GaitMotion:
    """The judged part of a walk, T ticks of n joints."""

    rate_hz: float
    torque: Floats
    """Shape (T, n) [N·m]."""
    joint_position: Floats
    """(T, n) [rad]"""
    alteration: Floats
    """Δ, shape (T,) [m]."""
    drag: Floats
    """Torques of a liquid's drag about the limbs' joints, summed, shape (T,) [N·m]."""
    leg_scale: float
    """Leg length over 0.93 m."""
    reference: float | None = None
    """Mean of Σ_i θ̈_di² of the reference poses [rad²/s⁴]; none without such poses."""


def f_energy(motion: GaitMotion) -> float:
    """Mean of Σ_i |τ_i| [N·m]: absolute, so that torques do not cancel."""
    return float(np.abs(motion.torque).sum(axis=1).mean())


def f_acceleration(motion: GaitMotion) -> float:
    """Mean of Σ_i q̈_i² [rad²/s⁴] of the resulting motion, by second differences.

    With reference poses three quarters of it and a quarter of theirs, squared as well: plain sums
    would cancel.
    """
    acceleration = np.diff(motion.joint_position, 2, axis=0) * motion.rate_hz**2
    actual = float(np.square(acceleration).sum(axis=1).mean())
    if motion.reference is None:
        return actual
    return REFERENCE_SHARE * motion.reference + (1.0 - REFERENCE_SHARE) * actual


def f_drag(motion: GaitMotion) -> float:
    """Mean of Σ_i |Σ_j (P_j − P_i) × F_j| [N·m], the drag's torques about the limbs' joints."""
    return float(motion.drag.mean())


TERMS: dict[str, Callable[[GaitMotion], float]] = {
    "energy": f_energy,
    "drag": f_drag,
    "acceleration": f_acceleration,
}
"""Terms of the sum, by name."""


def _weights(energy: float, drag: float, acceleration: float) -> dict[str, float]:
    return {"energy": energy, "drag": drag, "acceleration": acceleration}


WEIGHTINGS = {
    "3-6-1": _weights(3.0, 6.0, 1.0),
    "2-8-1": _weights(2.0, 8.0, 1.0),
    "4-5-1": _weights(4.0, 5.0, 1.0),
    "energy": _weights(1.0, 0.0, 0.0),
    "drag": _weights(0.0, 1.0, 0.0),
    "acceleration": _weights(0.0, 0.0, 1.0),
}
"""η, β, γ of seed 003_73fecd8ec8927aad, section 8.1, and one term alone; the seed chose 3-6-1."""


def terms_of(motion: GaitMotion) -> dict[str, float]:
    """Every term's value, not yet weighted."""
    return {name: term(motion) for name, term in TERMS.items()}


def f_sum(
    terms: Mapping[str, float], start: Mapping[str, float], weights: Mapping[str, float]
) -> float:
    """Σ w·f/f(start). A term that is 0 at the start counts as it is."""
    return sum(weight * terms[name] / (start[name] or 1.0) for name, weight in weights.items())


def alteration_factor(motion: GaitMotion) -> float:
    """1 + 0.1·R_ipm, R_ipm the mean of |Δ| over its limit."""
    limit = ALTERATION_LIMIT * motion.leg_scale
    return 1.0 + ALTERATION_WEIGHT * float(np.abs(motion.alteration).mean()) / limit


def f_speed(error: float, tolerance: float) -> float:
    """0 within the tolerance, beyond it up to 10¹⁰: the more, the further [m/s].

    The seed's step, given a slope so that the search sees where to go.
    """
    excess = max(0.0, abs(error) - tolerance) / tolerance
    return SPEED_WEIGHT * min(1.0, excess)


def f_recovery(share: float) -> float:
    """Cost of recovery steps that take a share of the judged time, up to 10¹⁵.

    The seed refuses a walk with one of them; here the more, the longer.
    """
    return BALANCE_WEIGHT * share


def f_balance(walked: float, *, pushed: bool) -> float:
    """Cost of the share of a walk that is missing, `walked` being 1 for a whole one.

    A walk that should not fall costs 10¹⁵ and more if it does. One that is pushed harder and
    harder is expected to: 100 times what is missing.
    """
    if walked >= 1.0:
        return 0.0
    return PUSHED_WEIGHT * (1.0 - walked) if pushed else BALANCE_WEIGHT * (2.0 - walked)
