"""The gait state machine: one stance foot at a time, a phase that runs from 0 to touch-down.

Seed 000_bd1305a0ae731442, section 3 (SIMBICON with one mirrored state); values of the first
author's walk: period 0.7 s, touch-down accepted after phase 0.4, step forced to end at phase 1.05.
"""

from dataclasses import dataclass

from pydantic import NonNegativeFloat

from hil.validation import Config


class GaitConfig(Config):
    """When a step may end, when it must, and what counts as contact."""

    period: float
    """Nominal time T of one step [s]."""
    min_phase: float
    """Touch-down is accepted after this phase."""
    max_phase: float
    """The step ends here even without touch-down."""
    touch_down_load: float
    """Vertical load on the swing foot that ends the step, as a fraction of body weight."""
    flat_corner_load: float = 0.0145
    """Load that makes a corner count as loaded, as a fraction of body weight (10 N of 70.4 kg)."""
    flat_time: NonNegativeFloat = 0.0
    """How long three corners must have been loaded without a break [s]; with noisy load cells
    more than 0, or a foot that just lands on its heel soon counts as flat."""


@dataclass(slots=True)
class Gait:
    """Phase, stance side and step count."""

    config: GaitConfig
    weight: float
    """Body weight [N]."""
    stance: int = 0
    """0 left, 1 right."""
    phase: float = 0.0
    steps: int = 0
    foot_flat: bool = False
    """Latched within a step once at least three corners of the stance foot are loaded."""
    time_in_step: float = 0.0
    """[s]"""
    _loaded_since: float | None = None
    """`time_in_step` since which three corners have been loaded."""

    @property
    def swing(self) -> int:
        """Index of the swing foot."""
        return 1 - self.stance

    @property
    def stance_sign(self) -> int:
        """+1 when the left foot is the stance foot, -1 when the right one is."""
        return 1 - 2 * self.stance

    def advance(self, dt: float, swing_load: float, rate: float = 1.0) -> bool:
        """Move the phase on by one tick; True when a new step begins.

        `swing_load` is the vertical force on the swing foot [N]; `rate` scales the phase speed
        (step-time adaptation).
        """
        self.phase += rate * dt / self.config.period
        self.time_in_step += dt
        touched = (
            self.phase > self.config.min_phase
            and swing_load > self.config.touch_down_load * self.weight
        )
        if not touched and self.phase < self.config.max_phase:
            return False
        self.stance = self.swing
        self.phase = 0.0
        self.time_in_step = 0.0
        self.steps += 1
        self.foot_flat = False
        self._loaded_since = None
        return True

    def update_foot_flat(self, loaded_corners: int) -> None:
        """Latch the flat stance foot, seed section 3 and its stored code: three of four corners."""
        if loaded_corners < 3:
            self._loaded_since = None
            return
        if self._loaded_since is None:
            self._loaded_since = self.time_in_step
        if self.time_in_step - self._loaded_since > self.config.flat_time - 1e-9:
            self.foot_flat = True
