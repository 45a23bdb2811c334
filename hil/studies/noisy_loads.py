"""Load cells with noise in front of any estimator's loads, for experiments with a true state."""

from dataclasses import replace

import numpy as np

from hil.interface import Estimate, Estimator, SensorFrame


class NoisyLoads:
    """Implements `hil.interface.Estimator`: every corner force carries white noise.

    f = f_estimate + N(0, σ) in every tick and corner, unfiltered. Nothing else changes.
    """

    def __init__(self, estimator: Estimator, deviation_n: float, seed: int) -> None:
        self._estimator, self._deviation = estimator, deviation_n
        self._random = np.random.default_rng(seed)

    def update(self, frame: SensorFrame) -> Estimate:
        """The estimate with noisy corner forces."""
        estimate = self._estimator.update(frame)
        noise = self._random.normal(0.0, self._deviation, estimate.foot_force.shape)
        return replace(estimate, foot_force=estimate.foot_force + noise)
