"""Root balance: the hips carry what keeps the pelvis upright.

Seed 000_bd1305a0ae731442, section 3 (SIMBICON's torso rule), with the load sharing of the first
author's stored code.
"""

import math

import numpy as np

from controller.walking.torque_config import RootBalanceConfig
from hil.interface import Floats


def hip_moment(root: Floats, swing_hip: Floats, others: Floats) -> Floats:
    """M = −(τ_root + τ_swing-hip + Σ τ_other) [N·m]: what the hips must add.

    The pelvis receives the reaction of every torque on its children. With M added at the hips
    the sum of the reactions is the torque τ_root that the pelvis asks for. `others` are the
    torques on the remaining children of the root, shape (k, 3).
    """
    moment: Floats = -(root + swing_hip + np.add.reduce(others))
    return moment


def stance_share(stance_load: float, swing_load: float) -> tuple[float, float]:
    """Parts of M for the stance and the swing hip, (λ, 1 − λ) by vertical load; (0, 0) in flight.

    λ = F_stance/(F_stance + F_swing).
    """
    total = stance_load + swing_load
    if total <= 0.0:
        return 0.0, 0.0
    share = stance_load / total
    return share, 1.0 - share


def hip_damping(config: RootBalanceConfig, relative_rate: Floats) -> Floats:
    """Stance-hip damping −c·|ω|·clip(ω, ±ω_max) [N·m], of the hip's relative rate ω [rad/s]."""
    limit = config.hip_damping_limit
    rates = relative_rate.tolist()
    factor = -config.hip_damping * math.hypot(*rates)
    return np.array([factor * min(max(rate, -limit), limit) for rate in rates])
