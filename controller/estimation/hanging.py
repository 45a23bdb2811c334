"""The state of a robot whose feet may not touch: joints and tilt are measured, contacts are timed.

Without a foot on the ground there is no odometry and no touch-down. What a walk needs of them comes
from its own schedule.
"""

import math

import numpy as np

from controller.estimation.sensors import SensorEstimator
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Estimate, Floats, SensorFrame, WalkStatus

LANDING_PHASE = 1.0
"""Phase of a step at which the swing foot counts as landed."""


class HangingEstimator:
    """Joints, tilt and angular velocity from the sensors; place, heading and contact assumed.

    The base rests above the world's origin, as high as the lower sole says, and heads along x: a
    rope lets it turn, and no step turns it back. While the controller walks, the stance foot
    carries the weight W, a quarter a corner, until phase 1; then the swing foot does, and the step
    ends. While it does not walk, loads are the measured ones.
    """

    def __init__(self, description: RobotDescription, rate_hz: int, status: WalkStatus) -> None:
        """`status` is the controller's own, read in every tick."""
        self._sensors = SensorEstimator(description, rate_hz)
        self._status = status
        self._model = model = RobotModel(description)
        self._corner_load = model.weight / 4.0
        self.estimate = self._sensors.estimate

    def update(self, frame: SensorFrame) -> Estimate:
        """The estimate at the frame's time. The returned object is reused by the next call."""
        estimate, model = self._sensors.update(frame), self._model
        _turn_to_x(estimate.base_orientation)
        estimate.base_position[:] = 0.0
        estimate.base_linear_velocity[:] = 0.0
        model.set_state(estimate)
        estimate.base_position[2] = -model.corner_positions[:, :, 2].min()
        np.add(model.com, estimate.base_position, out=estimate.com)
        estimate.com_velocity[:] = model.com_velocity
        if self._status.walking:
            self._time_contacts(estimate)
        return estimate

    def _time_contacts(self, estimate: Estimate) -> None:
        status = self._status
        landed = status.phase >= LANDING_PHASE
        carrying = 1 - status.stance if landed else status.stance
        estimate.foot_force[carrying] = self._corner_load
        estimate.foot_force[1 - carrying] = 0.0
        estimate.contact[carrying], estimate.contact[1 - carrying] = True, False


def _turn_to_x(orientation: Floats) -> None:
    """Take the yaw ψ out of an orientation (w, x, y, z): q ← (cos ψ/2, 0, 0, −sin ψ/2)·q."""
    w, x, y, z = orientation.tolist()
    half = -0.5 * math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    c, s = math.cos(half), math.sin(half)
    orientation[:] = (c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w)
