"""Walking conditions of `stride study robustness`, as data: what is asked, and what is changed."""

import math
from typing import Literal

from pydantic import Field, PositiveFloat, PositiveInt

from hil.schedule import Point, Schedules
from hil.validation import Config

TURN_PIECE_S = 0.02
"""A turn at a limited rate is asked for in small pieces, this far apart."""
TURN_START_S = 5.0
STEP_S = 0.32
"""A walk of so many steps is given this time for each: a little more than a step takes."""

Side = Literal["forward", "back", "left", "right"]


class Condition(Config):
    """One row of the table: a command, and what differs from the robot as it ships."""

    goal: str
    """What is wanted of it."""
    speed: float = 0.2
    """Sagittal [m/s]."""
    lateral: float = 0.0
    """Left positive [m/s]."""
    turn_deg: float = 0.0
    """Angle of a turn that begins after 5 s."""
    turn_rate: PositiveFloat = 1.0
    """[rad/s]"""
    duration_s: PositiveFloat = 20.0
    steps: PositiveInt | None = None
    """The walk is as long as so many steps take."""
    pushes: tuple[Side, ...] = ()
    """Directions of pushes of 0.3 s; each phase is a walk of its own."""
    push_froude: float = Field(default=0.0, ge=0)
    """Size of the pushes as Δv/√(gL)."""
    overrides: tuple[str, ...] = ()
    """`KEY=VALUE` changes of the description."""

    @property
    def time_s(self) -> float:
        """How long the walk takes [s]."""
        return self.duration_s if self.steps is None else self.steps * STEP_S

    @property
    def schedules(self) -> Schedules:
        """What the operator asks for."""
        return Schedules(
            speed=((0.0, self.speed),), lateral=((0.0, self.lateral),), turns=self._turns()
        )

    def _turns(self) -> tuple[Point, ...]:
        angle = math.radians(self.turn_deg)
        pieces = max(1, round(abs(angle) / self.turn_rate / TURN_PIECE_S))
        times = (TURN_START_S + piece * TURN_PIECE_S for piece in range(pieces))
        return tuple((time, angle / pieces) for time in times) if angle else ()


NO_FALL = "no fall"

CONDITIONS: dict[str, Condition] = {
    "baseline": Condition(goal="flat ≥ 95 %, saturation ≤ 15 %, rms ≤ 25 % of stall"),
    "forward": Condition(goal="200 steps, error ≤ 5 %", speed=0.30, steps=200),
    "fast": Condition(goal="stretch", speed=0.35),
    "fastest": Condition(goal="stretch", speed=0.45, overrides=("supply.voltage=14.8",)),
    "backward": Condition(goal=NO_FALL, speed=-0.2),
    "left": Condition(goal=NO_FALL, speed=0.0, lateral=0.10),
    "right": Condition(goal=NO_FALL, speed=0.0, lateral=-0.10),
    "in-place": Condition(goal=NO_FALL, speed=0.0),
    "turn": Condition(goal="115° at 1 rad/s", speed=0.25, turn_deg=115.0),
    "push-sagittal": Condition(
        goal="all eight phases", speed=0.1, pushes=("forward", "back"), push_froude=0.25
    ),
    "push-lateral": Condition(
        goal="all eight phases", speed=0.1, pushes=("left", "right"), push_froude=0.20
    ),
    "soft-pads": Condition(goal=NO_FALL, overrides=("plant.pad_stiffness=0.5",)),
    "hard-pads": Condition(goal=NO_FALL, overrides=("plant.pad_stiffness=2",)),
    "dead-cell": Condition(goal=NO_FALL, overrides=("plant.dead_cells=['left_foot:front_left']",)),
    "low-battery": Condition(goal=NO_FALL, overrides=("supply.voltage=10.5",)),
    "two-ticks": Condition(goal=NO_FALL, overrides=("plant.latency_ticks=1",)),
    "noisy-cells": Condition(goal=NO_FALL, overrides=("noise.corner_force=5",)),
    "heavy-torso": Condition(goal=NO_FALL, overrides=("plant.mass_scale=1.25",)),
    "slippery": Condition(goal=NO_FALL, overrides=("plant.floor_friction=0.4",)),
    "ten-minutes": Condition(goal="no fall; time to 70 °C", duration_s=600.0),
}
"""Those of the minibiped, by name. Wires and computer take about a tick: one more makes two."""
