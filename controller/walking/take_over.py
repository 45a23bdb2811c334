"""Take-over: from when on the pendulum model owns the swing foot.

Seed 003_73fecd8ec8927aad, section 5.2: the place of the foot only matters while the body falls, so
the pendulum takes over when the centre of mass begins to sink. First author's code: not before
phase 0.2, latched to the end of the step, at once in a recovery step.
"""

from dataclasses import dataclass
from typing import Literal

from pydantic import Field

from hil.validation import Config


class TakeOverConfig(Config):
    """When the pendulum takes the swing foot over."""

    earliest: float = Field(ge=0, lt=1)
    """Not before this phase, but in a recovery step."""
    rule: Literal["falling", "phase"]
    """`falling` waits for the centre of mass to sink, `phase` only for the earliest phase."""


@dataclass(slots=True)
class TakeOver:
    """The phase φ_0 of the take-over, latched until the end of the step.

    φ_0 is 0 in a recovery step, else the first φ ≥ φ_earliest at which v_z < 0.
    """

    config: TakeOverConfig
    phase: float | None = None
    """φ_0; none while the foot is not yet taken over."""

    def begin_step(self, recovering: bool) -> None:
        """A new step begins."""
        self.phase = 0.0 if recovering else None

    def update(self, phase: float, vertical_speed: float) -> None:
        """See a tick's phase and vertical speed of the centre of mass [m/s]."""
        if self.phase is None and phase >= self.config.earliest:
            if self.config.rule == "phase":
                self.phase = self.config.earliest
            elif vertical_speed < 0.0:
                self.phase = phase
