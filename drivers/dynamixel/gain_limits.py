"""Which stiffness and damping a joint's servo can have in its mode, and saying no at the start."""

from dataclasses import dataclass

from drivers.dynamixel.control_table import OperatingMode
from drivers.dynamixel.servo_models import ServoModel, find_servo_model
from hil.description import Joint
from hil.errors import InputError
from hil.interface import Floats
from hil.servo import (
    COUNTS_PER_RADIAN,
    COUNTS_PER_TURN,
    JOINT_MODES,
    PWM_FULL,
    MotorParameters,
    ServoMode,
)

P_GAIN_MAX = 16383
DAMPING_TOLERANCE = 0.02
"""A damping this close below the motor's own counts as the motor's own."""
DAMPING_MAX_FACTOR = 2.0
"""Largest damping, as a multiple of the motor's own: the rest is made on the host from a delayed
velocity, which must not exceed what two ticks of delay leave stable (assumed)."""


@dataclass(frozen=True, slots=True)
class Feasible:
    """What a joint can be asked for."""

    stiffness: tuple[float, float]
    """[N·m/rad]"""
    damping: tuple[float, float]
    """[N·m·s/rad]"""


def position_stiffness(motors: MotorParameters) -> Floats:
    """Stiffness of one count of P gain and one volt in position mode [N·m/rad/V], shape (n,).

    Duty a count is P/(885·D): τ₀(V)·c/(885·D) = V·(k_t/R)·c/(885·D).
    """
    stall_per_volt = motors.torque_constant / motors.resistance
    per_volt: Floats = stall_per_volt * COUNTS_PER_RADIAN / (PWM_FULL * motors.gain_divisor)
    return per_volt


def current_stiffness(motors: MotorParameters) -> Floats:
    """Stiffness of one count of P gain in current-based position mode [N·m/rad], shape (n,).

    The PID asks for P/D₅ current counts I₁ a position count: k_t·I₁·c/D₅. NaN without current.
    """
    if motors.current_unit is None or motors.current_divisor is None:
        return motors.torque_constant * float("nan")
    per_count: Floats = (
        motors.torque_constant * motors.current_unit * COUNTS_PER_RADIAN / motors.current_divisor
    )
    return per_count


def feasible(
    motors: MotorParameters, joint: int, mode: ServoMode, voltage: float, delay_s: float
) -> Feasible:
    """Ranges of one joint at a supply voltage [V].

    In position mode the motor's back-EMF damping k_t²/R is the least there is. With current
    control it is regulated away and damping is the host's, as is stiffness in current mode: a
    spring whose position is `delay_s` old eats kp·delay of damping, which must not be more than
    the motor's own.
    """
    own = float(motors.back_emf_damping()[joint])
    if mode is ServoMode.POSITION:
        count = float(position_stiffness(motors)[joint]) * voltage
        low = own * (1 - DAMPING_TOLERANCE)
        return Feasible((count, count * P_GAIN_MAX), (low, own * DAMPING_MAX_FACTOR))
    damping = (0.0, own * DAMPING_MAX_FACTOR)
    if mode is ServoMode.CURRENT:
        return Feasible((0.0, own / delay_s), damping)
    count = float(current_stiffness(motors)[joint])
    return Feasible((count, count * P_GAIN_MAX), damping)


def usable_modes(model: ServoModel) -> tuple[str, ...]:
    """Modes in which a model can make a stiffness and a damping.

    A servo that regulates the current of its supply, u·i, cannot brake, since a braking motor
    gives current back, and its torque at rest goes with the root of the goal: position mode only.
    """
    if model.current_sensing == "supply":
        return ("position",)
    return tuple(
        name for name, number in JOINT_MODES.items() if OperatingMode(number) in model.modes
    )


def require_mode(joint: Joint) -> ServoMode:
    """The mode of a joint. Raises InputError when its servo does not have it."""
    mode = JOINT_MODES[joint.mode]
    model = None if joint.servo is None else find_servo_model(joint.servo)
    usable = ("position",) if model is None else usable_modes(model)
    if joint.mode not in usable:
        servo = joint.servo or "a servo that is not filled in"
        raise InputError(
            f"joint {joint.name}: {servo} cannot make a stiffness in mode {joint.mode}; "
            f"valid: {', '.join(usable)}"
        )
    return mode


def require_feasible(joint: Joint, limits: Feasible) -> None:
    """Raises InputError for default gains that the joint's servo cannot have."""
    for key, value, (low, high), unit in (
        ("stiffness", joint.stiffness, limits.stiffness, "N·m/rad"),
        ("damping", joint.damping, limits.damping, "N·m·s/rad"),
    ):
        if not low <= value <= high:
            raise InputError(
                f"joint {joint.name}: {joint.servo} cannot have {key} {value:g} {unit} in mode "
                f"{joint.mode}; feasible: {low:.3g} to {high:.3g}"
            )


def require_single_turn(joint: Joint, offset: float) -> None:
    """Raises InputError for a range that a servo's single turn does not cover."""
    ends = [(q + offset) * COUNTS_PER_RADIAN for q in joint.range]
    half_turn = COUNTS_PER_TURN / 2
    if min(ends) < -half_turn or max(ends) >= half_turn:
        raise InputError(
            f"joint {joint.name}: range {joint.range} with offset "
            f"{offset:.3f} rad leaves the servo's single turn (±3.14 rad)"
        )
