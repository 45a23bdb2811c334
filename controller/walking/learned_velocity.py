"""The learned velocity curve: the speed wanted at each phase of a step, learned from steps.

Seed 000_bd1305a0ae731442, section 3 (velocity component): a body on legs cannot move at constant
speed within a step. The curve learns the deviation that the walk has by itself, so that the virtual
force need not fight it and only holds the mean.
"""

import numpy as np

from controller.walking.heading_frame import Pair
from controller.walking.key_poses import CurveTable
from controller.walking.torque_config import LearnedVelocityConfig


class LearnedVelocity:
    """Deviation f(φ) from the desired speed, per stance side, sagittal and coronal.

    At a step's end, with the observed speed v at k uniform knots, normalised so that its median
    (or mean, as configured) is that of the desired speed, f_obs = v − median(v), and
    Δ = mean|f_obs − f|: if Δ is below the threshold, f ← f + r·clip(f_obs − f, ±Δ). So the curve
    learns a shape only: the mean speed is the offset's (`velocity_offset`). Knots are joined by
    Catmull-Rom splines; those that the step did not reach take its last deviation.
    """

    def __init__(self, config: LearnedVelocityConfig, capacity: int) -> None:
        """`capacity` is the largest number of ticks in a step."""
        self._config = config
        self._at = np.linspace(0.0, 1.0, config.knots)
        self.values = np.zeros((2, 2, config.knots))
        """Deviations [m/s] by stance side, axis (sagittal, coronal) and knot."""
        self._tables = [self._table(side) for side in range(2)]
        self._capacity = capacity
        self._phase: list[float] = []
        self._speed: list[Pair] = []

    def deviation(self, stance: int, phase: float) -> Pair:
        """Learned deviation, sagittal and coronal [m/s]."""
        sagittal, coronal = self._tables[stance].at(phase)
        return sagittal, coronal

    def observe(self, phase: float, velocity: Pair) -> None:
        """Record the speed of one tick [m/s]."""
        if len(self._phase) < self._capacity:
            self._phase.append(phase)
            self._speed.append(velocity)

    def end_step(self, stance: int, learn: bool) -> None:
        """Learn from the step that `stance` carried, or only forget its record."""
        phases, recorded = self._phase, np.array(self._speed)
        self._phase, self._speed = [], []
        if not learn or not phases:
            return
        median = self._config.normalise == "median"
        speed = recorded - (np.median if median else np.mean)(recorded, axis=0)
        for axis in range(2):
            observed = np.interp(self._at, phases, speed[:, axis])
            error = observed - self.values[stance, axis]
            mean = float(np.abs(error).mean())
            if mean < self._config.threshold:
                self.values[stance, axis] += self._config.rate * np.clip(error, -mean, mean)
        self._tables[stance] = self._table(stance)

    def reset(self) -> None:
        """Back to the constant desired speed."""
        self.values[:] = 0.0
        self._tables = [self._table(side) for side in range(2)]

    def _table(self, stance: int) -> CurveTable:
        curves = [list(zip(self._at, values, strict=True)) for values in self.values[stance]]
        return CurveTable(curves, 1.0)
