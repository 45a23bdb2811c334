"""The state of a robot from its own sensors: encoders, IMU and foot corners."""

from dataclasses import replace

import numpy as np

from controller.estimation.attitude import AttitudeFilter
from controller.estimation.config import EstimatorConfig
from controller.estimation.contact import ContactDetector
from controller.estimation.dead_cells import DeadCells
from controller.estimation.joint_state import JointStateFilter
from controller.estimation.level_trim import LevelTrim
from controller.estimation.odometry import CornerOdometry
from controller.estimation.rotation import turned
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Estimate, Floats, SensorFrame

_DEFAULT = EstimatorConfig()


class SensorEstimator:
    """Estimator of a robot with flat soles on flat ground.

    Order in a tick: contact, joints, attitude, then the model is placed with its base at the
    origin, the odometry moves the base, and com and com velocity follow from the model.
    """

    def __init__(
        self, description: RobotDescription, rate_hz: int, config: EstimatorConfig = _DEFAULT
    ) -> None:
        dt = 1.0 / rate_hz
        n = len(description.joints)
        self._model = RobotModel(description)
        weight = self._model.weight
        self._contact = ContactDetector(config.contact, weight, dt, DeadCells(weight, dt))
        self._joints = JointStateFilter(n, config.velocity_time, config.coast_time)
        self._attitude = AttitudeFilter(config, dt)
        self._trim = LevelTrim(config.trim, self._model.weight, dt)
        self._odometry = CornerOdometry(self._model, dt, config.trust_time)
        self.estimate = self._own_estimate(n)
        self._at_origin = replace(
            self.estimate, base_position=np.zeros(3), base_linear_velocity=np.zeros(3)
        )
        """The estimate with its base at rest at the origin; the other arrays are shared."""

    def _own_estimate(self, joints: int) -> Estimate:
        """An estimate whose joints and loads are the filters' own arrays: nothing to copy."""
        return replace(
            empty_estimate(joints),
            joint_position=self._joints.position,
            joint_velocity=self._joints.velocity,
            foot_force=self._contact.force,
            contact=self._contact.contact,
        )

    def update(self, frame: SensorFrame) -> Estimate:
        """The estimate at the frame's time. The returned object is reused by the next call."""
        estimate, model, contact = self.estimate, self._model, self._contact
        contact.update(frame.foot_force)
        self._joints.update(frame)
        estimate.time_ns = frame.time_ns
        self._update_attitude(frame)
        model.set_state(self._at_origin)
        odometry = self._odometry
        odometry.update(contact.corners, contact.contact.tolist())
        self._trim.update(model.root_rotation, model.feet, contact.corners)
        estimate.base_position[:] = odometry.position
        estimate.base_linear_velocity[:] = odometry.velocity
        np.add(model.com, estimate.base_position, out=estimate.com)
        np.add(model.com_velocity, estimate.base_linear_velocity, out=estimate.com_velocity)
        estimate.supply_voltage = supply_voltage(frame)
        return estimate

    def _update_attitude(self, frame: SensorFrame) -> None:
        attitude = self._attitude
        if attitude.hears_imu(frame):
            attitude.update_from_imu(frame)
            self._take_attitude(turned(attitude.orientation, self._trim.rotation))
            return
        estimate, model = self.estimate, self._model
        estimate.base_orientation[:] = (1.0, 0.0, 0.0, 0.0)
        estimate.base_angular_velocity[:] = 0.0
        model.set_state(self._at_origin)
        support = attitude.choose_support(self._contact.loads)
        attitude.update_from_foot(support, model.feet[support], model.foot_twists[support][:3])
        self._take_attitude(attitude.orientation)

    def _take_attitude(self, orientation: Floats) -> None:
        self.estimate.base_orientation[:] = orientation
        self.estimate.base_angular_velocity[:] = self._attitude.angular_velocity


def supply_voltage(frame: SensorFrame) -> float:
    """Mean voltage over the servos that report one [V]; NaN where none does."""
    total = float(np.add.reduce(frame.joint_voltage))
    if total == total:
        return total / frame.joint_voltage.size
    known = frame.joint_voltage[np.isfinite(frame.joint_voltage)]
    return float(known.mean()) if known.size else float("nan")


def empty_estimate(n: int) -> Estimate:
    """An estimate of n joints at rest at the origin, without contact."""
    return Estimate(
        time_ns=0,
        base_position=np.zeros(3),
        base_orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        base_linear_velocity=np.zeros(3),
        base_angular_velocity=np.zeros(3),
        joint_position=np.zeros(n),
        joint_velocity=np.zeros(n),
        com=np.zeros(3),
        com_velocity=np.zeros(3),
        foot_force=np.zeros((2, 4)),
        toe_force=np.zeros(2),
        contact=np.zeros(2, dtype=np.bool_),
        supply_voltage=float("nan"),
    )
