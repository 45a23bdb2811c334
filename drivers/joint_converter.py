"""Raw servo states to joint measurements in SI."""

import numpy as np

from drivers.calibration import RobotCalibration
from drivers.dynamixel.control_table import VELOCITY_UNIT
from drivers.dynamixel.servo_models import ServoModel, servo_model_of
from drivers.dynamixel.states import ServoStates
from drivers.motor_constants import motor_parameters
from hil.description import RobotDescription
from hil.interface import NEVER_NS, SensorFrame
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN

LOAD_UNIT = 1e-3
"""Share of the stall torque in one count of a servo that measures load instead of current."""


class JointConverter:
    """Fills the joint part of a SensorFrame.

    q = direction·(counts − 2048)/COUNTS_PER_RADIAN − offset; the torque is the measured current
    times the torque constant (or the measured load times the stall torque).
    """

    def __init__(self, description: RobotDescription, calibration: RobotCalibration) -> None:
        direction = np.array([float(joint.direction) for joint in description.joints])
        motors = motor_parameters(description, calibration)
        models = [servo_model_of(joint) for joint in description.joints]
        self._position_scale = direction / COUNTS_PER_RADIAN
        self._velocity_scale = direction * VELOCITY_UNIT
        self._torque_scale = direction * [
            _torque_unit(model, float(constant))
            for model, constant in zip(models, motors.torque_constant, strict=True)
        ]
        self._zero = CENTRE_COUNTS * self._position_scale + calibration.offsets(
            description.joint_names
        )

    def convert(self, states: ServoStates, frame: SensorFrame) -> None:
        """Write positions, velocities, torques, ages and the slow values into a frame."""
        np.multiply(states.position, self._position_scale, out=frame.joint_position)
        frame.joint_position -= self._zero
        np.multiply(states.velocity, self._velocity_scale, out=frame.joint_velocity)
        np.multiply(states.current, self._torque_scale, out=frame.joint_torque)
        frame.joint_voltage[:] = states.voltage
        frame.joint_temperature[:] = states.temperature
        frame.joint_error[:] = states.error
        frame.joint_valid[:] = states.valid
        # Samples are taken after the tick's begin: within the tick they have no age.
        np.maximum(frame.time_ns - states.time_ns, 0, out=frame.joint_age_ns)
        if not frame.joint_valid.all():
            frame.joint_age_ns[states.time_ns < 0] = NEVER_NS


def _torque_unit(model: ServoModel, torque_constant: float) -> float:
    """Torque of one count of Present Current or Present Load [N·m]."""
    if model.current_unit is None:
        return LOAD_UNIT * model.stall_torque
    return model.current_unit * torque_constant
