"""The objective of the gain study: what makes a gain set small or large, and its walk acceptable.

Seed 000_bd1305a0ae731442, section 4.1, equation 4, over the judged time of k seconds:

    f_eval = f_gains + Σ_{t<k} (f_head + f_hands) / (k·frequency) + f_speed + f_balance

The weights and tolerances are those of the first author's public code (`scarensac/simbicon_qt`,
`gui/ControllerEditor.cpp`, snapshot 2020-03-05), given for a leg of 0.93 m. On another robot,
lengths scale with the leg, speeds with the square root of leg and gravity.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from hil.interface import Floats

GAINS_WEIGHT = 64.0
LARGEST_MEAN = 3.0
"""Mean of the normalised gains at which the cost of a search for large gains is zero."""
MOTION_WEIGHT = 1e8
LENGTH_UNIT_M = 0.01
"""Excess of a place at which its penalty is full, for a leg of 0.93 m [m]."""
ANGLE_UNIT_RAD = 0.01
"""The same of an angle [rad]."""
SPEED_WEIGHT = 1e10
SPEED_SHARE = 0.05
SPEED_LEAST = 0.02
"""Least tolerance of a speed, for a leg of 0.93 m [m/s]."""
BALANCE_WEIGHT = 1e19

Band = tuple[float, float]
"""Least and largest value that is still similar."""


def f_gains(gains: Sequence[float], start: Sequence[float], largest: bool) -> float:
    """Cost of a set's size: small for small gains, or for large ones.

    With m the mean of the gains, each divided by its start so that none is favoured: 64·m for the
    smallest, 64·(3 − m)/3 for the largest. Gains that start at zero do not count.
    """
    ratios = [gain / first for gain, first in zip(gains, start, strict=True) if first > 0.0]
    mean = sum(ratios) / len(ratios)
    return GAINS_WEIGHT * ((LARGEST_MEAN - mean) / LARGEST_MEAN if largest else mean)


def f_outside(values: Floats, band: Band, unit: float) -> float:
    """Mean over the ticks of 10⁸·min(1, (e/unit)²), e being how far a value is outside a band.

    `values` has the shape (T,) or (T, m); several columns add up.
    """
    low, high = band
    excess = np.maximum(np.maximum(low - values, values - high), 0.0) / unit
    penalties = np.minimum(1.0, excess * excess)
    return float(MOTION_WEIGHT * penalties.sum() / len(values))


def f_motion(motion: Mapping[str, Floats], bands: Mapping[str, Band], scale: float) -> float:
    """Σ (f_head + f_hands)/(k·frequency): how far end effectors leave the places they had.

    `motion` holds the columns of `motion.MotionMeter`; `scale` is the leg length over 0.93 m.
    Only quantities with a band count.
    """
    return sum(f_outside(motion[name], band, unit_of(name, scale)) for name, band in bands.items())


def unit_of(name: str, scale: float) -> float:
    """Excess of full penalty of a quantity of motion [m or rad]."""
    return ANGLE_UNIT_RAD if name in ("head_pitch", "head_roll") else LENGTH_UNIT_M * scale


def f_speed(speed: float, wanted: float, tolerance: float) -> float:
    """10¹⁰·min(1, ((|v − v*| − tolerance)/tolerance)⁴) beyond the tolerance [m/s]."""
    excess = max(0.0, abs(speed - wanted) - tolerance) / tolerance
    return SPEED_WEIGHT * min(1.0, excess**4)


def speed_tolerance(wanted: float, scale: float) -> float:
    """5 % of a speed, at least 0.02 m/s at human scale [m/s]; `scale` as in `f_motion`."""
    return max(SPEED_SHARE * abs(wanted), SPEED_LEAST * math.sqrt(scale))


def f_balance(walked_s: float, duration_s: float) -> float:
    """10¹⁹ to twice that for a walk that ended early: the earlier, the more."""
    if walked_s >= duration_s:
        return 0.0
    return BALANCE_WEIGHT * (2.0 - walked_s / duration_s)
