"""How the ground reaction force is spread over the sides of one foot."""

from collections.abc import Sequence
from typing import NamedTuple


class Distribution(NamedTuple):
    """r_side = F_side/F_all of seed 000_bd1305a0ae731442, section 3.1.3.

    Left and right are shares of the sole alone, front and rear of sole and toe, since toes are
    a body of their own that only lengthens the foot (its stored code). Without load all are 0.
    """

    left: float
    right: float
    front: float
    rear: float
    sole: float
    """Load on the four corners [N]."""
    total: float
    """F_all: load on corners and toe [N]."""

    @property
    def least(self) -> float:
        """The smallest share of a side."""
        return min(self[:4])


def distribution(forces: Sequence[float]) -> Distribution:
    """Of the normal forces [N] of front_left, front_right, rear_left, rear_right and the toe."""
    front_left, front_right, rear_left, rear_right, toe = forces
    sole = front_left + front_right + rear_left + rear_right
    total = sole + toe
    side = 1.0 / sole if sole > 0.0 else 0.0
    end = 1.0 / total if total > 0.0 else 0.0
    return Distribution(
        (front_left + rear_left) * side,
        (front_right + rear_right) * side,
        (front_left + front_right + toe) * end,
        (rear_left + rear_right) * end,
        sole,
        total,
    )
