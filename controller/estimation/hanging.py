"""The state of a robot whose feet may not touch: joints and tilt are measured, contacts are timed.

Without a foot on the ground there is no odometry and no touch-down. What a walk needs of them comes
from its own schedule.
"""

import numpy as np

from controller.estimation.rotation import about_vertical, product, yaw
from controller.estimation.sensors import SensorEstimator
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Estimate, SensorFrame, WalkStatus

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
        orientation = estimate.base_orientation
        orientation[:] = product(about_vertical(-yaw(orientation)), orientation)
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
