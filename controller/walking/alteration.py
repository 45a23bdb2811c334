"""Alteration of the foot placement: an integral over steps that removes the steady speed error.

The inverted pendulum's step is right only for its model; Δ, added to its distance, adapts at the
end of every step until the mean speed of a step is the wanted one.
"""

from dataclasses import dataclass, field

from pydantic import PositiveFloat

from hil.validation import Config


class AlterationConfig(Config):
    """Gain and bounds of the integral."""

    gain: float
    """β [m per m/s]: Δ moved per step and speed error."""
    error_limit: PositiveFloat
    """A speed error counts no more than this [m/s]."""
    bounds: tuple[float, float]
    """Smallest and largest Δ [m]."""
    start: float = 0.0
    """Δ of the first step [m]."""


@dataclass(slots=True)
class Alteration:
    """Δ_s = clip(Δ_{s−1} + β·clip(V̄ − V*, ±e_max), Δ_min, Δ_max), at the end of step s.

    V̄ is the mean speed of the step. Δ < 0 shortens the step, which makes the body faster.
    The first author's stored code, β = 0.1 s; seed 003_73fecd8ec8927aad, section 5, has it as
    Δ_s = Δ_{s−1} + β(V − V*).
    """

    config: AlterationConfig
    value: float = field(init=False)
    """Δ [m]."""

    def __post_init__(self) -> None:
        self.value = self.config.start

    def end_step(self, mean_speed: float, wanted_speed: float) -> None:
        """Adapt Δ to the mean speed [m/s] of the step that ended."""
        limit = self.config.error_limit
        error = min(max(mean_speed - wanted_speed, -limit), limit)
        low, high = self.config.bounds
        self.value = min(max(self.value + self.config.gain * error, low), high)
