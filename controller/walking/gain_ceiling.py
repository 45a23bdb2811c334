"""The closed-form ceiling of gains: how much damping explicit PD can have at a control rate.

Seed 000_bd1305a0ae731442, section 5.2, finds by search that gains must fall with the rate. This is
the bound of the integrator behind it, from the robot's model alone.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from controller.walking.linear_stance import LinearStance, StancePose
from hil.description import RobotDescription
from hil.interface import Floats
from hil.joint_gains import GainSet

NOTHING = 1e-6
"""A joint that may grow a million times has no ceiling."""


def flip_matrix(damping: Floats, stiffness: Floats, period_s: float) -> Floats:
    """D + h/2·K: what stands against M where a motion changes sign every tick.

    Semi-implicit Euler, v⁺ = v − h·M⁻¹·(D·v + K·q) and q⁺ = q + h·v⁺, with v⁺ = −v: the
    displacement is then q = h·v/2, and 2·v = h·M⁻¹·(D + h/2·K)·v.
    """
    return damping + 0.5 * period_s * stiffness


def largest_factor(mass: Floats, matrix: Floats, period_s: float) -> float:
    """s with h·λ_max(M⁻¹·s·matrix) = 2, infinite where nothing is positive."""
    values = np.linalg.eigvals(np.linalg.solve(mass, matrix)).real
    highest = float(values.max())
    return 2.0 / (period_s * highest) if highest > 0.0 else float("inf")


def largest_share(mass: Floats, matrix: Floats, others: Floats, period_s: float) -> float:
    """Least s > 0 with h·λ(M⁻¹·(others + s·matrix)) = 2; 0 where the others are beyond it alone.

    (2/h·M − others)·v = s·matrix·v: 1/s is an eigenvalue of (2/h·M − others)⁻¹·matrix.
    """
    if largest_factor(mass, others, period_s) < 1.0:
        return 0.0
    room = 2.0 / period_s * mass - others
    values = np.linalg.eigvals(np.linalg.solve(room, matrix))
    real = values.real[np.abs(values.imag) <= 1e-6 * np.abs(values).max()]
    highest = float(real.max(initial=0.0))
    return 1.0 / highest if highest > NOTHING else float("inf")


class GainCeiling:
    """h·λ_max(M⁻¹·D) ≤ 2 for the whole control law, in the poses of a walk.

    A velocity that explicit PD damps by more than twice itself within a tick comes back larger
    with the other sign. D is here D + h/2·K (`flip_matrix`), on the mass of a robot whose stance
    foot is on the floor (`LinearStance`). The root's damping acts on the mean rate of two ticks,
    which is zero where the rate changes sign every tick: it is no part of D. The bound is that of
    small motions that have the time to grow; torque limits and the loss of contact are beyond it.
    """

    def __init__(
        self, description: RobotDescription, poses: Sequence[StancePose], *, welded: bool = True
    ) -> None:
        """Raises DescriptionError for a walking section that does not fit."""
        self._stance = LinearStance(description)
        self._poses = poses
        self._welded = welded

    def whole(self, gains: GainSet, rate_hz: float) -> Floats:
        """Largest common factor on all gains of a set in each pose, shape (poses,).

        Below 1 the set itself is beyond the ceiling.
        """
        period = 1.0 / rate_hz
        every = dict.fromkeys(gains, 1.0)
        return np.array(
            [
                largest_factor(stance.mass, self._flip(stance, gains, every, period), period)
                for stance in self._placed()
            ]
        )

    def alone(self, gains: GainSet, joint: str, rate_hz: float) -> Floats:
        """Largest factor on the gains of one joint, the others as they are, shape (poses,)."""
        period = 1.0 / rate_hz
        own = {name: float(name == joint) for name in gains}
        rest = {name: 1.0 - share for name, share in own.items()}
        return np.array(
            [
                largest_share(
                    stance.mass,
                    self._flip(stance, gains, own, period),
                    self._flip(stance, gains, rest, period),
                    period,
                )
                for stance in self._placed()
            ]
        )

    def _placed(self) -> Iterator[LinearStance]:
        """The robot in one pose after the other."""
        for pose in self._poses:
            self._stance.place(pose, welded=self._welded)
            yield self._stance

    def _flip(
        self, stance: LinearStance, gains: GainSet, factors: Mapping[str, float], period_s: float
    ) -> Floats:
        stiffness = np.array([factors[row] * gains[row][0] for row in stance.rows])
        damping = np.array([factors[row] * gains[row][1] * (row != "root") for row in stance.rows])
        return flip_matrix(stance.matrix(damping), stance.matrix(stiffness), period_s)
