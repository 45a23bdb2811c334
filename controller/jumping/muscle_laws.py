"""The two laws of a muscle spring across a bent joint: force from bend and bend from force.

Seed 004_2880d7939e94ed85, section 3.2.1. A spring of stiffness k [N/m] and no rest length sits on
two bones, each end at the distance r [m] from the joint; θ [rad] is the bend, 0 where the bones
lie on one line. In both laws only the product k·r counts for the force.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from hil.errors import InputError


def mitre_force(bend: float, stiffness: float, width: float) -> float:
    """F = k·r/cos(θ/2) [N]: the seed's formula, solved for the force.

    The spring is as long as the mitre of two bones of half width r. It never goes slack: a
    straight joint has F = k·r, and F grows without bound towards θ = π.
    """
    return stiffness * width / math.cos(0.5 * bend)


def mitre_bend(force: float, stiffness: float, width: float) -> float:
    """θ = acos(2k²r²/F² − 1) [rad], as printed; raises InputError for F < k·r, which has none."""
    least = stiffness * width
    if force < least:
        raise InputError(
            f"muscle force {force:.4g} N is below k·r = {least:.4g} N, "
            "which a straight joint has already"
        )
    return math.acos(min(1.0, 2.0 * (least / force) ** 2 - 1.0))


def mitre_slope(bend: float, stiffness: float, width: float) -> float:
    """dF/dθ = ½·k·r·sin(θ/2)/cos²(θ/2) [N/rad]."""
    return 0.5 * stiffness * width * math.sin(0.5 * bend) / math.cos(0.5 * bend) ** 2


def chord_force(bend: float, stiffness: float, width: float) -> float:
    """F = 2·k·r·sin(θ/2) [N]: the spring is the chord between its two ends.

    What such a spring really does: slack when straight, 2·k·r when folded, k·r at 60°.
    """
    return 2.0 * stiffness * width * math.sin(0.5 * bend)


def chord_bend(force: float, stiffness: float, width: float) -> float:
    """θ = 2·asin(F/(2·k·r)) [rad]; raises InputError for F outside 0 … 2·k·r."""
    most = 2.0 * stiffness * width
    if not 0.0 <= force <= most:
        raise InputError(f"muscle force {force:.4g} N is outside 0 … 2·k·r = {most:.4g} N")
    return 2.0 * math.asin(force / most)


def chord_slope(bend: float, stiffness: float, width: float) -> float:
    """dF/dθ = k·r·cos(θ/2) [N/rad]."""
    return stiffness * width * math.cos(0.5 * bend)


@dataclass(frozen=True, slots=True)
class MuscleLaw:
    """One law; each function takes (bend or force, stiffness, width)."""

    name: str
    force: Callable[[float, float, float], float]
    bend: Callable[[float, float, float], float]
    slope: Callable[[float, float, float], float]
    strength: float
    """Sum of k·r over the legs in body weights, where nothing else is said. With 1 the straight
    legs of the mitre law carry the body; with 1.5 the chord law has the same force at bends of 42°
    and 138°."""


MITRE = MuscleLaw("mitre", mitre_force, mitre_bend, mitre_slope, 1.0)
CHORD = MuscleLaw("chord", chord_force, chord_bend, chord_slope, 1.5)
LAWS = {law.name: law for law in (MITRE, CHORD)}
