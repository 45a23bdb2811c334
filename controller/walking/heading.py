"""Heading: the operator's direction is reached over two steps, in a short ramp on each.

Seed 000_bd1305a0ae731442, section 3: a new desired heading is distributed over two character
steps, in each of which it moves linearly during 0.3 s. Both limit the yaw torque that a single
stance foot must carry.
"""

from dataclasses import dataclass

from pydantic import PositiveFloat, PositiveInt

from controller.walking.gait import Gait
from hil.validation import Config


class HeadingConfig(Config):
    """How a turn is spread over steps."""

    ramp_time: PositiveFloat
    """Duration of the ramp within one step [s]; the seed: 0.3 s for a leg of 0.94 m."""
    start_phase: float = 0.2
    """The ramp of a step starts at this phase."""
    steps: PositiveInt = 2
    """Steps over which a turn is distributed."""
    inner_foot_above: PositiveFloat | None = None
    """A larger turn [rad] waits for a step whose swing foot is on its inner side; none: never."""


@dataclass(slots=True)
class HeadingRamp:
    """Tracked heading ψ of the commanded heading ψ*.

    At the start phase of a step with s steps left of the turn, ψ begins a linear ramp of
    duration T_r towards ψ + (ψ* − ψ)/s; s counts down from `steps` to 1 after a new command.
    A command that comes later in a step waits for the next one: the swing foot could not follow.
    A large turn is begun by the inner foot, which steps out and not across the stance leg.
    """

    config: HeadingConfig
    heading: float = 0.0
    """Tracked heading ψ [rad]."""
    _wanted: float = 0.0
    _steps_left: int = 1
    _ramped_step: int = -1
    _rate: float = 0.0
    _ramp_left: float = 0.0

    def update(self, dt: float, gait: Gait, wanted: float) -> float:
        """Tracked heading one tick later [rad], for a commanded heading [rad]."""
        if wanted != self._wanted:
            self._wanted = wanted
            self._steps_left = self.config.steps
        if gait.phase >= self.config.start_phase and gait.steps != self._ramped_step:
            self._ramped_step = gait.steps
            if not self._waits(gait):
                self._begin_ramp()
        if self._ramp_left > 0.0:
            self.heading += self._rate * min(dt, self._ramp_left)
            self._ramp_left -= dt
        return self.heading

    @property
    def turning(self) -> bool:
        """Whether the tracked heading is still on its way."""
        return abs(self._wanted - self.heading) > 1e-9

    def _waits(self, gait: Gait) -> bool:
        """Whether a turn that has not begun needs the other foot first."""
        turn = self._wanted - self.heading
        threshold = self.config.inner_foot_above
        if threshold is None or self._steps_left < self.config.steps or abs(turn) <= threshold:
            return False
        return turn * gait.stance_sign > 0.0

    def _begin_ramp(self) -> None:
        share = (self._wanted - self.heading) / self._steps_left
        self._steps_left = max(1, self._steps_left - 1)
        self._rate = share / self.config.ramp_time
        self._ramp_left = self.config.ramp_time
