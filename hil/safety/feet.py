"""The foot cells: enough of them, and together about the robot's weight."""

import numpy as np

from hil.description import RobotDescription
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

LEAST_CELLS = 3
"""With fewer valid cells a foot's load and centre of pressure are unknown."""
MEAN_TIME_S = 0.5
"""Time constant of the mean load: more than a step."""
MAX_LOAD_ERROR = 0.4
"""Share of the weight by which the mean load may differ from it."""


class FeetMonitor:
    """Valid cells, and the mean of both feet's load F against the weight W.

        F̄ ← F̄ + (F − F̄)·h/τ,    |F̄ − W| > 0.4·W is not what a standing or walking robot weighs

    (style of a plausibility check; over whole steps the mean ground force of a body that neither
    rises nor sinks is its weight). It begins with the weight and is only judged while walking,
    not before one time constant has passed.
    """

    def __init__(self, description: RobotDescription, rate_hz: int, weight_n: float) -> None:
        self._boards = tuple(description.feet[side].board for side in ("left", "right"))
        self._complete = None not in self._boards
        self._share = 1.0 / (MEAN_TIME_S * rate_hz)
        self._weight = weight_n
        self._mean = weight_n
        self._patience = round(MEAN_TIME_S * rate_hz)

    def look(self, situation: Situation) -> list[Event]:
        """Feet without enough cells, loads that cannot be."""
        frame, events = situation.frame, []
        if np.count_nonzero(frame.foot_valid) < frame.foot_valid.size:
            cells = np.count_nonzero(frame.foot_valid, axis=1).tolist()
            for board, valid in zip(self._boards, cells, strict=True):
                if board is not None and 0 < valid < LEAST_CELLS:
                    events.append(Event(board, "too few valid cells", Severity.SOFT_STOP))
        if not (situation.walking and self._complete):
            return events
        self._mean += (float(frame.foot_force.sum()) - self._mean) * self._share
        self._patience -= 1
        if self._patience < 0 and abs(self._mean - self._weight) > MAX_LOAD_ERROR * self._weight:
            events.append(Event("feet", "load is not the weight", Severity.SOFT_STOP))
        return events
