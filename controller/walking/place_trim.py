"""Where the com really is above each foot, learnt from how it falls."""

from dataclasses import dataclass, field

from pydantic import Field, PositiveFloat

from controller.walking.heading_frame import Pair
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
    """δ per foot and axis: by how much the com is seen ahead of where it acts.

    The pendulum obeys v̇ = ω²(x − δ − cop) with the true com at x − δ. Over the single support of
    a step, of duration t, δ = mean(x − cop) − (v_end − v_begin)/(ω²·t), of which δ takes over a
    share. It collects what no sensor tells apart: joint zeros of that leg, the pitch of the IMU,
    a torso that is not balanced as the model says.
    """

    config: PlaceTrimConfig
    value: list[Pair] = field(default_factory=lambda: [(0.0, 0.0), (0.0, 0.0)])
    """δ of the left and the right foot, heading frame [m]."""
    _ticks: int = 0
    _sum: Pair = (0.0, 0.0)
    _first: Pair = (0.0, 0.0)
    _last: Pair = (0.0, 0.0)
    _omega: float = 1.0

    def add(self, place: Pair, velocity: Pair, cop: Pair, omega: float) -> None:
        """One tick of single support: untrimmed place and cop from the ankle [m], v [m/s]."""
        if self._ticks == 0:
            self._first, self._sum = velocity, (0.0, 0.0)
        delay = self.config.delay
        self._sum = (
            self._sum[0] + place[0] - delay * velocity[0] - cop[0],
            self._sum[1] + place[1] - delay * velocity[1] - cop[1],
        )
        self._last, self._omega = velocity, omega
        self._ticks += 1

    def end_step(self, foot: int, dt: float) -> None:
        """Learn from the step that `foot` carried; `dt` is the period of the ticks [s]."""
        ticks, self._ticks = self._ticks, 0
        time = (ticks - 1) * dt
        if time < SHORTEST:
            return
        scale = self._omega**2 * time
        old = self.value[foot]
        self.value[foot] = (
            self._learn(old[0], self._sum[0] / ticks - (self._last[0] - self._first[0]) / scale),
            self._learn(old[1], self._sum[1] / ticks - (self._last[1] - self._first[1]) / scale),
        )

    def _learn(self, old: float, found: float) -> float:
        config = self.config
        error = max(-config.error_limit, min(found - old, config.error_limit))
        return max(-config.bound, min(old + config.gain * error, config.bound))
