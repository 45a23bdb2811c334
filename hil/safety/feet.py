"""The foot cells: enough of them, and together about the robot's weight."""

import numpy as np

from hil.description import RobotDescription
from hil.request import Feet
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

LEAST_CELLS = 3
"""With fewer valid cells a foot's load and centre of pressure are unknown."""
MEAN_TIME_S = 0.5
"""Time constant of the mean load: more than a step."""
MAX_LOAD_ERROR = 0.4
"""Share of the weight by which the mean load may differ from it."""
TOUCH_SHARE = 0.2
"""Share of the weight that the feet of a hoisted robot may seem to carry."""


class FeetMonitor:
    """Valid cells, and the mean of both feet's load F against the weight W.

        F̄ ← F̄ + (F − F̄)·h/τ,    |F̄ − W| > 0.4·W is not what a standing or walking robot weighs

    (style of a plausibility check; over whole steps the mean ground force of a body that neither
    rises nor sinks is its weight). It begins with the weight and is only judged while walking,
    not before one time constant has passed. The feet of a hoisted robot touch nothing: F̄ begins
    with 0 and stays below 0.2·W.
    """

    def __init__(
        self, description: RobotDescription, rate_hz: int, weight_n: float, feet: Feet = "carry"
    ) -> None:
        self._boards = tuple(description.feet[side].board for side in ("left", "right"))
        self._share = 1.0 / (MEAN_TIME_S * rate_hz)
        self._judged = None not in self._boards and feet not in ("either", "leap")
        self._expected = self._mean = 0.0 if feet == "hang" else weight_n
        self._tolerance = (TOUCH_SHARE if feet == "hang" else MAX_LOAD_ERROR) * weight_n
        self._wrong = "touch something" if feet == "hang" else "load is not the weight"
        self._patience = round(MEAN_TIME_S * rate_hz)

    def look(self, situation: Situation) -> list[Event]:
        """Feet without enough cells, loads that cannot be."""
        frame, events = situation.frame, []
        if np.count_nonzero(frame.foot_valid) < frame.foot_valid.size:
            cells = np.count_nonzero(frame.foot_valid, axis=1).tolist()
            for board, valid in zip(self._boards, cells, strict=True):
                if board is not None and 0 < valid < LEAST_CELLS:
                    events.append(Event(board, "too few valid cells", Severity.SOFT_STOP))
        if not (situation.walking and self._judged):
            return events
        self._mean += (float(frame.foot_force.sum()) - self._mean) * self._share
        self._patience -= 1
        if self._patience < 0 and abs(self._mean - self._expected) > self._tolerance:
            events.append(Event("feet", self._wrong, Severity.SOFT_STOP))
        return events
