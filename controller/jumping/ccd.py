"""Cyclic coordinate descent: the angles of a chain that bring its tip where it should be.

Seed 004_2880d7939e94ed85, algorithm 3.1 and section 3.2.3, with the angle that its cross product
leaves open, for hinges, and for a tip of several points, which holds a foot flat.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from controller.jumping.anderson import Anderson
from controller.jumping.chain import JointChain, cross_matrix
from hil.interface import Floats

SWEEPS = 100
"""Enough to converge, says the seed."""
ATTEMPT = 16
"""Sweeps after which an attempt that has not converged is given up."""
CANDIDATES = 30
"""Postures within the limits among which further attempts begin, the nearest first."""
STALL = 1e-3
"""A sweep that gains less than this share of the tolerance ends an attempt."""
EVEN = 1e-24
"""Squared lever [m⁴] below which every angle of a hinge is as good as any other."""


@dataclass(frozen=True, slots=True)
class CcdSolution:
    """The best that the descent found."""

    angles: Floats
    """Within the limits [rad], shape (k,)."""
    distance: float
    """Root mean square over the tip's points [m]."""
    sweeps: int
    """Of all attempts together."""
    converged: bool
    """The distance is within the tolerance."""


def sweep(chain: JointChain, angles: Floats, targets: Floats) -> tuple[Floats, float]:
    """Turn every hinge once, from the tip to the root; angles after it and the distance [m].

    With u_i and v_i from the hinge to the tip's points and to their targets, Σ|u_i − v_i|² is
    least at the turn atan2(Σ w·(u_i × v_i), Σ(u_i·v_i − (w·u_i)(w·v_i))) about the axis w. Beyond
    a limit it is least at the limit that is nearer on the circle.
    """
    anchors, axes, tip = chain.placed(angles)
    angles = angles.copy()
    lower, upper = chain.lower.tolist(), chain.upper.tolist()
    for hinge in range(len(angles) - 1, -1, -1):
        axis, lever, wanted = axes[hinge], tip - anchors[hinge], targets - anchors[hinge]
        along, across = lever @ axis, lever @ cross_matrix(axis).T
        sine = float((across * wanted).sum())
        cosine = float((lever * wanted).sum() - along @ (wanted @ axis))
        if sine * sine + cosine * cosine < EVEN:
            continue
        before = float(angles[hinge])
        after = _limited(before + math.atan2(sine, cosine), lower[hinge], upper[hinge])
        angles[hinge] = after
        c, s = math.cos(after - before), math.sin(after - before)
        tip = anchors[hinge] + c * lever + s * across + (1.0 - c) * along[:, None] * axis
    return angles, float(np.sqrt(np.square(tip - targets).sum() / len(tip)))


def _limited(angle: float, lower: float, upper: float) -> float:
    """The angle within its limits that is nearest to it on the circle [rad]."""
    if lower <= angle <= upper:
        return angle
    return lower if math.cos(lower - angle) > math.cos(upper - angle) else upper


def solve_ccd(
    chain: JointChain,
    start: Floats,
    targets: Floats,
    *,
    tolerance: float,
    sweeps: int = SWEEPS,
) -> CcdSolution:
    """Bring the tip to its targets [m], shape (p, 3), in root axes, within `tolerance` [m].

    Begins at `start` [rad], shape (k,). Where the descent ends short of the targets, caught
    between limits, it begins anew elsewhere within the limits; `sweeps` are for all attempts.
    For targets out of reach the solution is at the least distance that was found.
    """
    best, least, done = start, math.inf, 0
    for begin in _starts(chain, start, targets):
        budget = min(sweeps - done, ATTEMPT)
        angles, distance, used = _descend(chain, begin, targets, tolerance, budget)
        done += used
        # An attempt that is better by rounding alone shall not turn the leg about.
        if distance < least - STALL * tolerance:
            best, least = angles, distance
        if least <= tolerance or done >= sweeps:
            break
    return CcdSolution(best, least, done, least <= tolerance)


def _descend(
    chain: JointChain, angles: Floats, targets: Floats, tolerance: float, sweeps: int
) -> tuple[Floats, float, int]:
    """One attempt: sweeps, each followed by an extrapolation that the next sweep must justify."""
    mixing = Anderson()
    best, least, held = angles, math.inf, False
    for used in range(1, sweeps + 1):
        after, distance = sweep(chain, angles, targets)
        if distance < least:
            gain, best, least = least - distance, after, distance
            if distance <= tolerance or (gain < STALL * tolerance and held):
                return best, least, used
            held = gain < STALL * tolerance
            angles = np.clip(mixing.next(angles, after), chain.lower, chain.upper)
        elif held:
            return best, least, used
        else:
            mixing, angles, held = Anderson(), best, True
    return best, least, sweeps


def _starts(chain: JointChain, start: Floats, targets: Floats) -> Iterator[Floats]:
    """The given start, then postures that fill the limits evenly, the nearest to the targets first.

    The additive recurrence with the powers of the root of x^(k+1) = x + 1 (Roberts 2018).
    """
    yield np.clip(start, chain.lower, chain.upper)
    count = len(chain.joints)
    root = 2.0
    for _ in range(64):
        root = (1.0 + root) ** (1.0 / (count + 1))
    shares = (0.5 + np.outer(np.arange(CANDIDATES), root ** -np.arange(1.0, count + 1))) % 1.0
    candidates = chain.lower + shares * (chain.upper - chain.lower)
    distances = [float(np.square(chain.points(each) - targets).sum()) for each in candidates]
    yield from candidates[np.argsort(distances)]
