"""What a servo model alone says of its gains: figures for tables, experiments and pictures."""

from drivers.dynamixel.gain_limits import Feasible, feasible, position_stiffness, usable_modes
from drivers.dynamixel.servo_models import find_servo_model
from drivers.motor_constants import single_servo
from hil.servo import JOINT_MODES

TYPICAL_DELAY_S = 0.0045
"""From a sample to the middle of the tick in which its goal acts: 300 Hz on a fast bus."""


def servo_facts(servo: str) -> dict[str, float]:
    """Figures of a servo model at its recommended voltage, in SI. Raises UnknownNameError."""
    model = find_servo_model(servo)
    return {
        "voltage": model.voltage,
        "stall_torque": model.stall_torque,
        "no_load_speed": model.no_load_speed,
        "back_emf_damping": model.back_emf_damping,
        "position_stiffness": model.voltage * float(position_stiffness(single_servo(model))[0]),
    }


def feasible_gains(servo: str, mode: str) -> Feasible | None:
    """What a servo model can be asked for in a mode at its voltage; None if it lacks the mode."""
    model = find_servo_model(servo)
    if mode not in usable_modes(model):
        return None
    return feasible(single_servo(model), 0, JOINT_MODES[mode], model.voltage, TYPICAL_DELAY_S)
