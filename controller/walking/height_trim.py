"""How high the ground is for each foot, learnt from where it lands."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.bounds import clip
from hil.interface import Floats
from hil.validation import Config


class HeightTrimConfig(Config):
    """How fast a foot's path is raised."""

    gain: float = Field(ge=0, le=1)
    """Share of the error that is learnt in one step."""
    bound: PositiveFloat
    """Largest correction [m]."""


@dataclass(slots=True)
class HeightTrim:
    """Height of the ground as the left and the right foot see it, above where it is thought.

    When a foot has landed, both feet are on the ground, so the loaded corners of the one and of the
    other, Σf·z/Σf, are equally high. What the joints say instead is the error of their zeros, 4 mm
    a degree: a foot that is lower than thought lands early and drags its toe before. A foot's value
    moves by a share of the difference that is left. A path is only raised: lowering one costs the
    clearance that noise and lag need.
    """

    config: HeightTrimConfig
    value: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """[m]"""

    def land(self, foot: int, corners: Floats, loads: Sequence[Sequence[float]]) -> None:
        """`foot` has landed: corner points (2, 4, 3) [m] and their loads [N]."""
        new, old = loads[foot], loads[1 - foot]
        if sum(new) <= 0.0 or sum(old) <= 0.0:
            return
        found = _height(corners[foot], new) - _height(corners[1 - foot], old)
        bound = self.config.bound
        error = clip(found - self.value[foot], bound)
        self.value[foot] = max(0.0, min(self.value[foot] + self.config.gain * error, bound))


def _height(corners: Floats, loads: Sequence[float]) -> float:
    """Mean height of corners, each by its load [m]."""
    positive = [max(load, 0.0) for load in loads]
    heights = zip(corners[:, 2].tolist(), positive, strict=True)
    moment = float(sum(height * load for height, load in heights))
    return moment / sum(positive)
