"""Where the com really is ahead of each foot, learnt from how it falls."""

from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.bounds import clip
from hil.validation import Config

SHORTEST = 0.08
"""A step observed for less teaches nothing [s]."""


class PlaceTrimConfig(Config):
    """How much is believed of a step."""

    gain: float = Field(ge=0, le=1)
    """Share of the error that is learnt in one step."""
    error_limit: PositiveFloat
    """An error counts no more than this: a push is no lesson [m]."""
    bound: PositiveFloat
    """Largest correction [m]."""
    settle_time: float = Field(ge=0)
    """The first moments of a step, with its impact, are left out [s]."""
    delay: float = Field(ge=0)
    """Lag of the filtered corner forces and joint velocities: places are taken that old [s]."""


@dataclass(slots=True)
class PlaceTrim:
    """δ per foot, sagittal: by how much the com is seen ahead of where it acts.

    The pendulum obeys v̇ = ω²(x − δ − cop) with the true com at x − δ. Over the single support of
    a step, of duration t, δ = mean(x − cop) − (v_end − v_begin)/(ω²·t), of which δ takes over a
    share. It collects what no sensor tells apart: joint zeros of that leg, the pitch of the IMU,
    a torso that is not balanced as the model says.

    Not so sideways: there the com stays on one side of the foot, and a fall that is slower than
    the pendulum's, since legs swing less than the torso and so turn about the com, looks like a
    com nearer to the foot. A robot without any error learnt 9 mm, and stepped 130 mm wide instead
    of 105.
    """

    config: PlaceTrimConfig
    value: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """δ of the left and the right foot [m]."""
    _ticks: int = 0
    _sum: float = 0.0
    _first: float = 0.0
    _last: float = 0.0
    _omega: float = 1.0

    def add(self, place: float, velocity: float, cop: float, omega: float) -> None:
        """One tick of single support: untrimmed place and cop from the ankle [m], v [m/s]."""
        if self._ticks == 0:
            self._first, self._sum = velocity, 0.0
        self._sum += place - self.config.delay * velocity - cop
        self._last, self._omega = velocity, omega
        self._ticks += 1

    def end_step(self, foot: int, dt: float) -> None:
        """Learn from the step that `foot` carried; `dt` is the period of the ticks [s]."""
        ticks, self._ticks = self._ticks, 0
        time = (ticks - 1) * dt
        if time < SHORTEST:
            return
        scale, config = self._omega**2 * time, self.config
        old = self.value[foot]
        found = self._sum / ticks - (self._last - self._first) / scale
        error = clip(found - old, config.error_limit)
        self.value[foot] = clip(old + config.gain * error, config.bound)
