"""The evaluation function of a contact distribution: Eq. 1-3 of the seed, as resolved.

Seed 000_bd1305a0ae731442, section 3.1.3. As printed, 10·f_quality is at most 0.45, so that
f_eval < 1 accepts everything, and the one-sided f_distance makes it free to unload a good side.
The seed's stored code weights the quality by 1000 and the distance by 10, both here, and takes
the distance two-sided.
"""

import math
from dataclasses import dataclass

from controller.walking.stabilizer.distribution import Distribution

QUALITY_WEIGHT = 1000.0
DISTANCE_WEIGHT = 10.0
ACCEPTED = 1.0
"""Samples with f_eval below this are accepted."""
LIFTED = 1e16
"""f_quality of a foot without load is a tenth of this."""
LOAD_DECADES = 10.0
"""A foot that gains the least load loses so many decades of f_quality."""
LIGHT_SOLE = (0.75, 1e5)
"""Below this part of the least load the sole alone is too light (toes carry), and its quality."""


@dataclass(frozen=True, slots=True)
class Evaluation:
    """f_eval = 10·f_quality + f_distance (Eq. 1).

    f_quality = 1e16/10^(10·F_all/F_min + 1) below the least load F_min (100 N of the human), else
    1000·Σ max(l − r_side, 0)² (Eq. 2). f_distance = 10·Σ (r_side − clamp(r_init, l, 1−l))²
    (Eq. 3). Sums run over left and right, and once the foot is flat over front and rear too.
    """

    band: float
    """l, the share of the load that every side should carry."""
    least_load: float
    """F_min [N]."""

    def quality(self, now: Distribution, flat: bool, band: float | None = None) -> float:
        """f_quality; `band` replaces l."""
        if now.total < self.least_load:
            return LIFTED / math.pow(10.0, LOAD_DECADES * now.total / self.least_load + 1.0)
        if now.sole < LIGHT_SOLE[0] * self.least_load:
            return LIGHT_SOLE[1]
        limit = self.band if band is None else band
        missing = 0.0
        for share in now[:4] if flat else now[:2]:
            if share < limit:
                missing += (limit - share) ** 2
        return QUALITY_WEIGHT * missing

    def distance(self, now: Distribution, initial: Distribution, flat: bool) -> float:
        """f_distance from the distribution without extra torque."""
        low, high = self.band, 1.0 - self.band
        total = 0.0
        for side in range(4 if flat else 2):
            total += (now[side] - min(max(initial[side], low), high)) ** 2
        return DISTANCE_WEIGHT * total

    def total(self, now: Distribution, initial: Distribution, flat: bool) -> float:
        """f_eval."""
        return 10.0 * self.quality(now, flat) + self.distance(now, initial, flat)
