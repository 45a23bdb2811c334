"""The bias of a gyro, renewed while the robot still hangs or sits limp before it is armed."""

import math
from collections.abc import Sequence

import numpy as np

from drivers.boards.frames import GYRO_UNIT, ORIENTATION_UNIT, ImuFrame, ImuStatus
from hil.interface import Floats

LISTEN_NS = 1_000_000_000
"""How long one listens [ns]: noise of 0.02 rad/s at 600 frames a second becomes 0.0008 rad/s."""
LEAST_FRAMES = 100
MOST_UNREST = math.radians(5.0)
"""Standard deviation of an axis of a gyro at rest [rad/s] (assumed)."""
MOST_BIAS = math.radians(5.0)
"""More is a motion [rad/s] (assumed)."""
MOST_TURN = math.radians(0.5)
"""By which the sensor's own orientation may change meanwhile [rad]: a hand that turns the robot
slowly and evenly looks like a bias to the gyro alone."""
_ENDS = 0.2
"""Share of the frames at either end whose mean orientation counts."""


def bias_at_rest(frames: Sequence[ImuFrame]) -> Floats | None:
    """Mean angular velocity of a sensor that did not move [rad/s], its own axes, shape (3,).

    None where it moved, or too little was heard: the bias of the calibration then stands.
    """
    good = [frame for frame in frames if frame.status & ImuStatus.ALL == ImuStatus.ALL]
    if len(good) < LEAST_FRAMES:
        return None
    rates = GYRO_UNIT * np.array([frame.gyro for frame in good], dtype=float)
    bias: Floats = rates.mean(axis=0)
    restless = float(rates.std(axis=0).max()) > MOST_UNREST or float(np.abs(bias).max()) > MOST_BIAS
    return None if restless or _turned(good) > MOST_TURN else bias


def _turned(frames: Sequence[ImuFrame]) -> float:
    """Angle between the mean orientations of both ends [rad]."""
    part = max(1, round(_ENDS * len(frames)))
    ends = []
    for some in (frames[:part], frames[-part:]):
        mean = ORIENTATION_UNIT * np.array([frame.orientation for frame in some]).mean(axis=0)
        ends.append(mean / np.linalg.norm(mean))
    return 2.0 * math.acos(min(1.0, abs(float(np.dot(ends[0], ends[1])))))
