"""Where the swing foot goes in a walk: from its hip, along and across the heading."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import SIDES, Floats
from hil.posed_model import PosedModel
from hil.trace import Trace

STEPS = 6
"""The last whole steps, which are looked at."""


def swing_way(
    description: RobotDescription, trace: Trace, ahead: Floats, aside: Floats
) -> tuple[Floats, Floats] | None:
    """Place of the swing ankle at phases `ahead`, along the heading, and `aside`, across it [m].

    Means over the last steps, as of a step on the left foot: left is positive there. None for a
    walk with fewer steps.
    """
    last = int(trace.steps[-1]) if len(trace) else 0
    if last <= STEPS:
        return None
    body = _Legs(description)
    along, across = [], []
    for step in range(last - STEPS, last):
        ticks = np.flatnonzero(trace.steps == step)
        stance = int(trace.stance[ticks[0]])
        places = np.array([body.swing_place(trace, int(tick), 1 - stance) for tick in ticks])
        phases = trace.phase[ticks]
        along.append(np.interp(ahead, phases, places[:, 0]))
        across.append(np.interp(aside, phases, places[:, 1]) * (1 - 2 * stance))
    return np.mean(along, axis=0), np.mean(across, axis=0)


class _Legs:
    """Hips and ankles of a recorded tick, by forward kinematics."""

    def __init__(self, description: RobotDescription) -> None:
        self._body = PosedModel(description)
        model = self._body.model
        self._hips = [model.joint(f"{side}_hip_pitch").id for side in SIDES]
        self._ankles = [model.joint(description.feet[side].ankle).id for side in SIDES]  # type: ignore[index]

    def swing_place(self, trace: Trace, tick: int, swing: int) -> tuple[float, float]:
        """Ankle from hip in the heading frame [m]."""
        self._body.place_tick(trace, tick)
        data = self._body.data
        x, y, _ = (data.xanchor[self._ankles[swing]] - data.xanchor[self._hips[swing]]).tolist()
        cos, sin = np.cos(trace.heading[tick]), np.sin(trace.heading[tick])
        return float(cos * x + sin * y), float(cos * y - sin * x)
