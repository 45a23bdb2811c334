"""How high the feet are lifted in a walk."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import SIDES
from hil.posed_model import PosedModel
from hil.studies.walks import step_starts
from hil.trace import Trace

STEPS = 4
"""The last steps, which are looked at."""
EVERY = 3
"""One tick in so many is looked at."""


def foot_lift(description: RobotDescription, trace: Trace) -> float | None:
    """Mean height of the highest point of the swing soles' centres over the last steps [m].

    None in a walk with fewer steps.
    """
    times, stance = step_starts(trace)
    if len(times) < STEPS + 1:
        return None
    body = PosedModel(description)
    soles = [body.model.geom(description.feet[side].sole).id for side in SIDES]  # type: ignore[index]
    begin = np.searchsorted(trace.time_s, times[-STEPS - 1 :])
    highest = []
    for step in range(STEPS):
        swing = soles[1 - int(stance[len(stance) - STEPS - 1 + step])]
        top = 0.0
        for tick in range(int(begin[step]), int(begin[step + 1]), EVERY):
            body.place_tick(trace, tick)
            top = max(top, float(body.data.geom_xpos[swing, 2]))
        highest.append(top)
    return float(np.mean(highest))
