"""The motor constants that the driver counts with: identified where they are, else nominal."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drivers.calibration import RobotCalibration, ServoCalibration
from drivers.dynamixel.servo_models import ServoModel, find_servo_model
from hil.description import Joint, RobotDescription
from hil.interface import Floats, Ints
from hil.servo import MotorParameters

X_SERIES_DIVISOR = 128
"""Position P Gain register units per internal unit (X-series e-manuals, position PID gain)."""

REFERENCE = "XM430-W350"
"""The 82 g servo whose heat the plant models."""


@dataclass(frozen=True, slots=True)
class UnnamedServo:
    """The servo of a joint whose file does not say yet which it is: a walk in MuJoCo needs none.

    At supply V its motor stalls at the joint's torque limit τ₀ and idles at its velocity limit ω₀:
    K = V/ω₀, R = K·V/τ₀, as `ServoModel` has it. Its controller is that of the X series.
    """

    torque_constant: float
    """[N·m/A = V·s/rad]"""
    resistance: float
    """[Ω]"""
    size: float
    """Stall power against that of the servo that heat is known of (`REFERENCE`)."""
    gain_divisor: int = X_SERIES_DIVISOR
    current_unit: None = None
    current_divisor: None = None

    @classmethod
    def of(cls, joint: Joint, voltage: float) -> "UnnamedServo":
        """The servo of a joint at a supply [V]."""
        constant = voltage / joint.velocity_limit
        known = find_servo_model(REFERENCE)
        power = joint.torque_limit * joint.velocity_limit
        size = power / (known.stall_torque * known.no_load_speed)
        return cls(constant, constant * voltage / joint.torque_limit, size)


def motor_parameters(
    description: RobotDescription, calibration: RobotCalibration
) -> MotorParameters:
    """Constants of every joint's servo. Raises UnknownNameError for an unknown model."""
    voltage = 0.0 if description.supply is None else description.supply.voltage
    pairs = [
        (_nominal(joint, voltage), calibration.servos.get(joint.name))
        for joint in description.joints
    ]
    return _parameters(pairs, np.array([joint.direction for joint in description.joints]))


def _nominal(joint: Joint, voltage: float) -> ServoModel | UnnamedServo:
    return find_servo_model(joint.servo) if joint.servo else UnnamedServo.of(joint, voltage)


def single_servo(model: ServoModel) -> MotorParameters:
    """Nominal constants of one servo, as arrays of one joint."""
    return _parameters([(model, None)], np.ones(1, dtype=np.int64))


def _parameters(
    pairs: Sequence[tuple[ServoModel | UnnamedServo, ServoCalibration | None]], direction: Ints
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
        size=_sizes([model for model, _ in pairs]),
    )


def _sizes(models: Sequence[ServoModel | UnnamedServo]) -> Floats | None:
    """None of a robot all of whose servos are named."""
    if all(isinstance(model, ServoModel) for model in models):
        return None
    return np.array([model.size if isinstance(model, UnnamedServo) else 1.0 for model in models])
