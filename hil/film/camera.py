"""Where the eye is: it follows the robot, but not its every step."""

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from hil.interface import Floats

FOLLOW_S = 1.0
"""The eye follows the mean place over so long."""
DISTANCE = 4.2
"""From the robot, in heights of its root body."""
AZIMUTH_DEG, ELEVATION_DEG = 140.0, -14.0
LOOK_AT = 0.85
"""Height of the point that is looked at, in heights of the root body."""


@dataclass(frozen=True, slots=True)
class Shot:
    """One picture's view."""

    look_at: Floats
    """World point [m], (3,)."""
    distance: float
    """[m]"""

    def camera(self) -> Any:
        """As an MjvCamera."""
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = self.look_at
        camera.distance = self.distance
        camera.azimuth, camera.elevation = AZIMUTH_DEG, ELEVATION_DEG
        return camera


def followed(places: Floats, rate_hz: float, height: float) -> list[Shot]:
    """A shot a tick for places of the root body [m], (T, 3), whose usual height is `height`."""
    half = max(1, round(0.5 * FOLLOW_S * rate_hz))
    padded = np.pad(places[:, :2], ((half, half), (0, 0)), mode="edge")
    sums = np.cumsum(np.vstack([np.zeros(2), padded]), axis=0)
    width = 2 * half + 1
    mean = (sums[width:] - sums[:-width]) / width
    return [Shot(np.array([x, y, LOOK_AT * height]), DISTANCE * height) for x, y in mean.tolist()]
