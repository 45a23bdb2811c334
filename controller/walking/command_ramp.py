"""Rate limit of the commanded speed: a jump would fell the robot at low control rates."""

from dataclasses import dataclass

from pydantic import PositiveFloat

from hil.validation import Config


class CommandConfig(Config):
    """How fast the commanded speed may change."""

    acceleration: PositiveFloat
    """On each axis [m/s²]."""


@dataclass(slots=True)
class CommandRamp:
    """V*, sagittal and coronal, following the operator's speed by at most a·h a tick."""

    config: CommandConfig
    speed: tuple[float, float] = (0.0, 0.0)
    """V* [m/s]."""

    def update(self, dt: float, sagittal: float, lateral: float) -> tuple[float, float]:
        """V* one tick later [m/s]."""
        step = self.config.acceleration * dt
        u, v = self.speed
        self.speed = (
            u + min(max(sagittal - u, -step), step),
            v + min(max(lateral - v, -step), step),
        )
        return self.speed
