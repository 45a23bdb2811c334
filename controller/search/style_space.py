"""The 51 variables of a gait style: key points of its poses and of the swing foot's way.

Seed 003_73fecd8ec8927aad, section 6: three key points of the pelvis, two of the joint between
pelvis and torso, eleven of each ankle, five of the stance knee, all about the lateral axis, and of
the swing foot three, five and eleven across, down and ahead.
"""

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from controller.search.gait_space import POSE_BOUND, POSE_SPREAD, Variable, bounds_of
from controller.walking.gait_styles import GaitStyles
from controller.walking.torque_config import KeyPoses, torque_walking_config
from hil.description import RobotDescription
from hil.interface import Floats

ELEVEN = tuple(round(0.1 * index, 1) for index in range(11))
POSE_KNOTS: dict[str, tuple[float, ...]] = {
    "root_pitch": (0.02, 0.5, 0.98),
    "back_pitch": (0.0, 1.0),
    "stance_foot": ELEVEN,
    "swing_foot": ELEVEN,
    "stance_knee": (0.02, 0.25, 0.5, 0.75, 1.0),
    "swing_drop": (0.0, 0.25, 0.5, 0.75, 1.0),
}
"""Phases of the key points; where the seed leaves them open, those of its stored controllers."""
WAY_KNOTS: dict[str, tuple[float, ...]] = {"swing_aside": (0.0, 0.5, 1.0), "swing_ahead": ELEVEN}
"""The same of the swing foot's way from its hip, as far as a style says it."""


class StyleSpace:
    """One style for a speed and a liquid level, sought from the style that walks there now.

    A pose starts from what the combiner makes of the robot's styles there, read at the phases of
    the key points. The foot's way starts from `way`, values at the phases of WAY_KNOTS. Where the
    pendulum takes the foot over at a fixed phase, key points behind it cannot act: they keep their
    start and are no variables.
    """

    def __init__(
        self, description: RobotDescription, speed: float, level: float, way: Mapping[str, Floats]
    ) -> None:
        """`speed` [m/s], `level` [m]. Raises DescriptionError."""
        config = torque_walking_config(description)
        self._speed, self._level = speed, level
        self._others = [
            style.model_dump(mode="json")
            for style in config.chosen_styles
            if style.cell != (speed, level, 1.0)
        ]
        styles = GaitStyles(config)
        styles.choose(speed, level)
        names = list(KeyPoses.model_fields)
        self._starts: dict[str, list[float]] = {
            name: [styles.curves.at(phase)[names.index(name)] for phase in phases]
            for name, phases in POSE_KNOTS.items()
        } | {name: [float(value) for value in way[name]] for name in WAY_KNOTS}
        self._phases = POSE_KNOTS | WAY_KNOTS
        earliest = config.take_over.earliest if config.take_over.rule == "phase" else 1.0
        self.variables = tuple(
            _variable(name, index, value)
            for name, values in self._starts.items()
            for index, value in enumerate(values)
            if name not in WAY_KNOTS or _acts(self._phases[name], index, earliest)
        )

    def bounds(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Least and largest entry of every variable."""
        return bounds_of(self.variables)

    def style(self, vector: Sequence[float]) -> dict[str, Any]:
        """An entry of `walking.styles`."""
        values = {name: list(starts) for name, starts in self._starts.items()}
        for variable, change in zip(self.variables, vector, strict=True):
            values[variable.keys[0]][variable.place[0]] += variable.spread * change
        poses = {
            name: [
                [phase, round(value, 4)] for phase, value in zip(phases, values[name], strict=True)
            ]
            for name, phases in self._phases.items()
        }
        return {"speed": self._speed, "water": self._level, "poses": poses}

    def values(self, vector: Sequence[float]) -> dict[str, Any]:
        """All styles of the robot with this one among them."""
        return {
            "walking.styles": [*self._others, self.style(vector)],
            "walking.use_references": False,
        }


def _variable(name: str, index: int, value: float) -> Variable:
    reach = POSE_BOUND * POSE_SPREAD
    return Variable((name,), (index, 1), value, POSE_SPREAD, value - reach, value + reach)


def _acts(phases: Sequence[float], index: int, earliest: float) -> bool:
    """A key point shapes its curve up to the second one before it."""
    return index <= bisect_left(phases, earliest) + 1


def reference_acceleration(
    description: RobotDescription, speed: float, level: float, end_phase: float = 0.9
) -> float:
    """Mean of Σ_i θ̈_di² of the reference poses at a speed and a level [rad²/s⁴].

    Of the curves that turn joints, over the phases of a step of nominal length.
    """
    config = torque_walking_config(description)
    styles = GaitStyles(config)
    styles.choose(speed, level)
    turning = len(KeyPoses.model_fields) - 1  # all but the foot's drop, the last
    step = 0.01
    phases = np.arange(0.0, end_phase, step)
    angles = np.array([styles.curves.at(phase)[:turning] for phase in phases.tolist()])
    acceleration = np.diff(angles, 2, axis=0) / (step * config.gait.period) ** 2
    return float(np.square(acceleration).sum(axis=1).mean())
