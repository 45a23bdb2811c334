"""When the stabilizer searches at all."""

from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.distribution import Distribution
from controller.walking.stabilizer.evaluation import Evaluation


def triggered(
    config: StabilizerConfig, evaluation: Evaluation, initial: Distribution, flat: bool
) -> bool:
    """Whether a loaded foot's quality, at the trigger band, exceeds the threshold.

    Stored code of seed 000_bd1305a0ae731442: band 0.15 is guaranteed, 0.2 aimed at. A foot
    below the least load is on its way up or down; no torque of one tick can change that.
    """
    if initial.total < evaluation.least_load:
        return False
    quality = evaluation.quality(initial, flat, config.trigger_band)
    return quality > config.trigger_quality
