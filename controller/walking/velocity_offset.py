"""Offset of the learned velocity curve: it holds the mean speed where the curve holds the shape.

Seed 000_bd1305a0ae731442, section 3: the virtual force follows a curve of the variation within a
step plus an offset that gives control over the average speed.
"""

from dataclasses import dataclass, field

from pydantic import Field, NonNegativeFloat

from controller.walking.heading_frame import Pair
from hil.validation import Config


class VelocityOffsetConfig(Config):
    """Gain and memory of the offset, sagittal and coronal."""

    gain: tuple[NonNegativeFloat, NonNegativeFloat]
    """k: offset per mean speed error; 0.28 and 0.15 in the author's code."""
    memory: float = Field(ge=0, lt=1)
    """r: part of the last offset that is kept; 0.1 in the author's code."""
    limit: NonNegativeFloat
    """Largest offset [m/s]."""


@dataclass(slots=True)
class VelocityOffset:
    """o_s = clip(r·o_{s−1} + k·(V* − V̄), ±o_max) at the end of step s, V̄ its mean speed."""

    config: VelocityOffsetConfig
    value: Pair = field(default=(0.0, 0.0))
    """o, sagittal and coronal [m/s]."""

    def end_step(self, mean: Pair, wanted: Pair) -> None:
        """Adapt to the mean speed of a step [m/s]."""
        config = self.config
        limit = config.limit
        sagittal, coronal = (
            config.memory * last + gain * (goal - speed)
            for last, gain, goal, speed in zip(self.value, config.gain, wanted, mean, strict=True)
        )
        self.value = min(max(sagittal, -limit), limit), min(max(coronal, -limit), limit)

    def clear(self) -> None:
        """Forget it."""
        self.value = (0.0, 0.0)
