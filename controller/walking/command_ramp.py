"""Rate limit of the commanded speed: a jump would fell the robot at low control rates."""

from dataclasses import dataclass

from pydantic import PositiveFloat

from hil.interface import Floats
from hil.validation import Config


class CommandConfig(Config):
    """How fast the commanded speed may change."""

    acceleration: PositiveFloat
    """On each axis [m/s²]."""


@dataclass(slots=True)
class CommandRamp:
    """V*, sagittal and coronal, following the operator's speed by at most a·h a tick."""

    config: CommandConfig
    speed: Floats
    """V* [m/s], shape (2,)."""

    def update(self, dt: float, sagittal: float, lateral: float) -> Floats:
        """V* one tick later [m/s], shape (2,); the array is reused."""
        step = self.config.acceleration * dt
        for axis, wanted in enumerate((sagittal, lateral)):
            change = wanted - self.speed[axis]
            self.speed[axis] += min(max(change, -step), step)
        return self.speed
