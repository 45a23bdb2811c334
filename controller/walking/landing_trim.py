"""How far beside its goal each foot lands, learnt from step to step."""

from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.bounds import clip
from hil.validation import Config


class LandingTrimConfig(Config):
    """How much is believed of a landing."""

    gain: float = Field(ge=0, le=1)
    """Share of the error that is learnt in one step."""
    error_limit: PositiveFloat
    """An error counts no more than this: a push is no lesson [m]."""
    bound: PositiveFloat
    """Largest correction [m]."""
    min_phase: PositiveFloat
    """A foot that lands before this phase was still on its way, and teaches nothing."""


@dataclass(slots=True)
class LandingTrim:
    """β per foot, lateral: the foot is sent to y* − β so that it lands at y*.

    Iterative learning from step to step: β ← β + g·(y − y*), y where the foot stands when it has
    landed, both from the other ankle. The hips lag and bend under the body's weight, each servo in
    its own way: drawn robots set one foot down 8 mm too wide and the other one where it should
    be. The body then falls back to the middle sooner from the one than from the other, and with
    their timing adapted to that, steps are short in time and length on one foot, long on the other.
    """

    config: LandingTrimConfig
    value: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """β of the left and the right foot, heading frame, left positive [m]."""

    def land(self, foot: int, error: float, phase: float) -> None:
        """`foot` has landed at a phase, so far to the left of where it should have [m]."""
        config = self.config
        if phase < config.min_phase:
            return
        error = clip(error, config.error_limit)
        learnt = self.value[foot] + config.gain * error
        self.value[foot] = clip(learnt, config.bound)
