"""Recovery steps: after a disturbance the pendulum places the foot from the start of the step.

Seed 003_73fecd8ec8927aad, section 5.4 (velocity tuning).
"""

from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.heading_frame import Pair
from controller.walking.step_average import StepAverage
from hil.validation import Config


class RecoveryConfig(Config):
    """When a step is a recovery step."""

    threshold: PositiveFloat
    """Mean deviation from the learned speed that begins a recovery, and from the desired speed
    that ends it [m/s]; 0.1 for a leg of 0.94 m in the first author's code."""
    reset_after: int = Field(default=5, ge=1)
    """More recovery steps than these forget the learned curve."""


@dataclass(slots=True)
class Recovery:
    """Whether the present step is a recovery step, from the speeds of the last one.

    Entered when Δ_avg = mean|v − f| of a step reaches the threshold, f being the learned curve;
    left when mean|v − V*| is below it, V* being the desired speed. In a recovery step the
    pendulum owns the swing foot from phase 0, nothing is learned and Δ is not altered.
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
        judged = from_desired if self.active else from_learned
        self.active = judged >= self.config.threshold and not turning
        self.steps = self.steps + 1 if self.active else 0
        return self.steps == self.config.reset_after + 1
