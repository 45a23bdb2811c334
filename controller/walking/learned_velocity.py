"""The learned velocity curve: the speed wanted at each phase of a step, learned from steps.

Seed 000_bd1305a0ae731442, section 3 (velocity component): a body on legs cannot move at constant
speed within a step. The curve learns the deviation that the walk has by itself, so that the virtual
force need not fight it and only holds the mean.
"""

import numpy as np

from controller.walking.heading_frame import Pair
from controller.walking.key_poses import CurveTable
from controller.walking.torque_config import LearnedVelocityConfig
from hil.interface import Floats


class LearnedVelocity:
    """Deviation f(φ) from the desired speed, per stance side, sagittal and coronal.

    At a step's end, with the observed speed v at k uniform knots, normalised so that its median
    (or mean, as configured) is that of the desired speed, f_obs = v − median(v), and
    Δ = mean|f_obs − f|: if Δ is below the threshold, f ← f + r·clip(f_obs − f, ±Δ). So the curve
    learns a shape only: the mean speed is the offset's (`velocity_offset`). Knots are joined by
    Catmull-Rom splines; those that the step did not reach take its last deviation.

    Sagittally `scaled` (seed 003_73fecd8ec8927aad, section 5.4) the observed speed is brought to
    the desired one V* by a factor and not by a shift, f_obs = v·V*/mean(v) − V*, and so is what
    was learned at another V*: the curve is one of relative speeds.
    """

    def __init__(self, config: LearnedVelocityConfig, capacity: int) -> None:
        """`capacity` is the largest number of ticks in a step."""
        self._config = config
        self._at = np.linspace(0.0, 1.0, config.knots)
        self.values = np.zeros((2, 2, config.knots))
        """Deviations [m/s] by stance side, axis (sagittal, coronal) and knot."""
        self._learned_at = [0.0, 0.0]
        """Sagittal speed for which each side's curve was last learned [m/s]."""
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

    def end_step(self, stance: int, learn: bool, wanted: float) -> None:
        """Learn from the step that `stance` carried, or only forget its record.

        `wanted` is the commanded sagittal speed V* [m/s].
        """
        phases, recorded = self._phase, np.array(self._speed)
        self._phase, self._speed = [], []
        if not learn or not phases:
            return
        speed = self._normalised(recorded, stance, wanted)
        for axis in range(2):
            observed = np.interp(self._at, phases, speed[:, axis])
            error = observed - self.values[stance, axis]
            mean = float(np.abs(error).mean())
            if mean < self._config.threshold:
                self.values[stance, axis] += self._config.rate * np.clip(error, -mean, mean)
        self._tables[stance] = self._table(stance)

    def _normalised(self, recorded: Floats, stance: int, wanted: float) -> Floats:
        """Deviations of the recorded speeds from the desired ones, shape (ticks, 2) [m/s]."""
        median = self._config.normalise == "median"
        middle = (np.median if median else np.mean)(recorded, axis=0)
        speed: Floats = recorded - middle
        least = self._config.least_scaled
        if self._config.sagittal == "scaled" and abs(wanted) >= least:
            if wanted * middle[0] > 0.0 and abs(middle[0]) >= least:
                speed[:, 0] *= wanted / middle[0]
            if wanted * self._learned_at[stance] > 0.0:
                self.values[stance, 0] *= wanted / self._learned_at[stance]
            self._learned_at[stance] = wanted
        return speed

    def reset(self) -> None:
        """Back to the constant desired speed."""
        self.values[:] = 0.0
        self._tables = [self._table(side) for side in range(2)]

    def _table(self, stance: int) -> CurveTable:
        curves = [list(zip(self._at, values, strict=True)) for values in self.values[stance]]
        return CurveTable(curves, 1.0)
