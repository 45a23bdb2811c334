"""Recovery steps: after a disturbance the pendulum places the foot from the start of the step.

Seed 003_73fecd8ec8927aad, section 5.4 (velocity tuning).
"""

import math
from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.heading_frame import Pair
from controller.walking.step_average import StepAverage
from hil.validation import Config


class AdaptiveThreshold(Config):
    """A threshold that follows what a learned curve leaves over."""

    factor: float = Field(gt=1)
    """κ: threshold over the mean deviation that is left."""
    least: PositiveFloat
    """It is never below this [m/s]."""
    converged: float = Field(gt=0, lt=1)
    """The curve has converged when two steps' deviations differ by less than this part."""
    memory: float = Field(ge=0, lt=1)
    """r: part of the mean that is kept from step to step."""


class RecoveryConfig(Config):
    """When a step is a recovery step."""

    threshold: PositiveFloat
    """Mean deviation from the learned speed that begins a recovery, and from the desired speed
    that ends it [m/s]; 0.1 for a leg of 0.94 m in the first author's code."""
    reset_after: int = Field(default=5, ge=1)
    """More recovery steps than these forget the learned curve."""
    adaptive: AdaptiveThreshold | None = None
    """How the threshold of entry tightens with a learned curve; none keeps it where it is."""


@dataclass(slots=True)
class Recovery:
    """Whether the present step is a recovery step, from the speeds of the last one.

    Entered when Δ_avg = mean|v − f| of a step reaches the threshold, f being the learned curve;
    left when mean|v − V*| is below it, V* being the desired speed. In a recovery step the
    pendulum owns the swing foot from phase 0, nothing is learned and Δ is not altered, until the
    curve is reset and learning starts again.

    The seed's threshold ε is static, which it names as a limit (section 8.3). An adaptive one,
    after steps whose Δ_avg agree, enters at min(ε, max(ε_min, κ·Δ̄)), Δ̄ ← r·Δ̄ + (1 − r)·Δ_avg.
    """

    config: RecoveryConfig
    active: bool = False
    """The present step is a recovery step."""
    steps: int = 0
    """Recovery steps in a row, the present one included."""
    _learned: tuple[StepAverage, StepAverage] = field(
        default_factory=lambda: (StepAverage(), StepAverage())
    )
    _desired: StepAverage = field(default_factory=StepAverage)
    _left_over: float | None = None
    """Δ̄ [m/s]; none before the curve has converged."""
    _last: float = math.inf
    """Δ_avg of the last ordinary step [m/s]."""

    @property
    def frozen(self) -> bool:
        """Nothing is learned: the step is a recovery step, and the curve not yet reset."""
        return self.active and self.steps <= self.config.reset_after

    @property
    def threshold(self) -> float:
        """Δ_avg that begins a recovery [m/s]."""
        adaptive, static = self.config.adaptive, self.config.threshold
        if adaptive is None or self._left_over is None:
            return static
        return min(static, max(adaptive.least, adaptive.factor * self._left_over))

    def observe(self, velocity: Pair, learned: Pair, desired: Pair) -> None:
        """Count the speeds of one tick [m/s]; `learned` is that of the curve."""
        self._learned[0].add(abs(velocity[0] - learned[0]))
        self._learned[1].add(abs(velocity[1] - learned[1]))
        self._desired.add(abs(velocity[0] - desired[0]))

    def end_step(self, turning: bool) -> bool:
        """Judge the step that ended; True when the learned curve has to be reset.

        In a turn the heading frame rotates under the body: its speed then deviates by intent.
        """
        from_learned = max(self._learned[0].finish(), self._learned[1].finish())
        from_desired = self._desired.finish()
        if self.active:
            self.active = from_desired >= self.config.threshold and not turning
        else:
            self.active = from_learned >= self.threshold and not turning
        if self.config.adaptive is not None:
            self._adapt(self.config.adaptive, from_learned, turning)
        self.steps = self.steps + 1 if self.active else 0
        return self.steps == self.config.reset_after + 1

    def _adapt(self, adaptive: AdaptiveThreshold, deviation: float, turning: bool) -> None:
        """Follow the deviation of ordinary steps; a recovery or a turn begins anew."""
        if self.active or turning:
            self._left_over, self._last = None, math.inf
            return
        if self._left_over is not None:
            kept = adaptive.memory
            self._left_over = kept * self._left_over + (1.0 - kept) * deviation
        elif abs(deviation - self._last) < adaptive.converged * self._last:
            self._left_over = deviation
        self._last = deviation
