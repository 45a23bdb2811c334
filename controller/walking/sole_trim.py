"""Ankle angles at which each sole lies flat, learnt from where it is loaded."""

from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.bounds import clip
from controller.walking.heading_frame import Pair
from hil.validation import Config


class SoleTrimConfig(Config):
    """How fast soles are turned."""

    gain: float = Field(ge=0)
    """Angle a step, for an error of the centre of pressure [rad/m]."""
    bound: PositiveFloat
    """Largest angle [rad]."""


@dataclass(slots=True)
class SoleTrim:
    """(pitch, roll) added to the ankle of each foot.

    With e the mean of cop − p over the single support of a step, p the wanted centre of pressure:
    roll ← roll + k·e_y and pitch ← pitch − k·e_x. Rolling a foot about x presses its right edge
    down, pitching it about y its front. Joint zeros tilt each sole in its own way, and a sole on
    its edge has its cop there whatever torque the ankle gives; the level trim of the estimator
    knows only the mean of both feet, and only once they lie flat.
    """

    config: SoleTrimConfig
    value: list[Pair] = field(default_factory=lambda: [(0.0, 0.0), (0.0, 0.0)])
    """Pitch and roll of the left and the right ankle [rad]."""
    _ticks: int = 0
    _sum: Pair = (0.0, 0.0)

    def add(self, error: Pair) -> None:
        """cop − p of one tick of single support, heading frame [m]."""
        self._sum = (self._sum[0] + error[0], self._sum[1] + error[1])
        self._ticks += 1

    def end_step(self, foot: int) -> None:
        """Turn the foot that carried the step."""
        (x, y), ticks = self._sum, self._ticks
        self._sum, self._ticks = (0.0, 0.0), 0
        if ticks:
            share = self.config.gain / ticks
            pitch, roll = self.value[foot]
            bound = self.config.bound
            self.value[foot] = clip(pitch - share * x, bound), clip(roll + share * y, bound)
