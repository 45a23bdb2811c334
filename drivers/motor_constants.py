"""The motor constants that the driver counts with: identified where they are, else nominal."""

import numpy as np

from drivers.calibration import RobotCalibration, ServoCalibration
from drivers.dynamixel.servo_models import ServoModel, find_servo_model
from hil.description import RobotDescription
from hil.interface import Floats, Ints
from hil.servo import MotorParameters


def motor_parameters(
    description: RobotDescription, calibration: RobotCalibration
) -> MotorParameters:
    """Constants of every joint's servo. Raises UnknownNameError for an unknown model."""
    models = [find_servo_model(joint.servo or "") for joint in description.joints]
    direction = np.array([joint.direction for joint in description.joints])
    found = [calibration.servos.get(joint.name) for joint in description.joints]
    return _parameters(list(zip(models, found, strict=True)), direction)


def single_servo(model: ServoModel) -> MotorParameters:
    """Nominal constants of one servo, as arrays of one joint."""
    return _parameters([(model, None)], np.ones(1, dtype=np.int64))


def _parameters(
    pairs: list[tuple[ServoModel, ServoCalibration | None]], direction: Ints
) -> MotorParameters:
    def values(*numbers: float | None) -> Floats:
        return np.array([np.nan if number is None else number for number in numbers], dtype=float)

    return MotorParameters(
        torque_constant=values(*((own or model).torque_constant for model, own in pairs)),
        resistance=values(*((own or model).resistance for model, own in pairs)),
        gain_divisor=values(*((own or model).gain_divisor for model, own in pairs)),
        direction=direction,
        current_unit=values(*(model.current_unit for model, _ in pairs)),
        current_divisor=values(*(model.current_divisor for model, _ in pairs)),
    )
