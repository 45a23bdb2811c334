"""Ground truth in the shape of an estimate, for experiments and robots that exist in simulation."""

from collections.abc import Callable
from dataclasses import replace

from controller.estimation.config import ContactConfig
from controller.estimation.contact import ContactDetector
from controller.estimation.sensors import empty_estimate, supply_voltage
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Estimate, SensorFrame, Truth

EXACT_CONTACT = ContactConfig(filter_time=0.0, on=0.02, off=0.01)
"""Loads are exact: no filter, and thresholds just above nothing."""


class TruthEstimator:
    """Passes ground truth on; contact follows from the true loads with hysteresis."""

    def __init__(self, description: RobotDescription, truth: Callable[[], Truth]) -> None:
        self._truth = truth
        self._contact = ContactDetector(EXACT_CONTACT, RobotModel(description).weight, 1.0)
        contact = self._contact
        self.estimate = replace(
            empty_estimate(len(description.joints)),
            foot_force=contact.force,
            contact=contact.contact,
        )

    def update(self, frame: SensorFrame) -> Estimate:
        """The true state, at the frame's time. The returned object is reused by the next call."""
        truth, estimate = self._truth(), self.estimate
        estimate.time_ns = frame.time_ns
        estimate.base_position[:] = truth.base_position
        estimate.base_orientation[:] = truth.base_orientation
        estimate.base_linear_velocity[:] = truth.base_linear_velocity
        estimate.base_angular_velocity[:] = truth.base_angular_velocity
        estimate.joint_position[:] = truth.joint_position
        estimate.joint_velocity[:] = truth.joint_velocity
        estimate.com[:] = truth.com
        estimate.com_velocity[:] = truth.com_velocity
        self._contact.update(truth.foot_force)
        estimate.toe_force[:] = truth.toe_force
        estimate.supply_voltage = supply_voltage(frame)
        return estimate
