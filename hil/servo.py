"""What a servo is told and what its motor is: the seam between gain mapping and servo physics.

The driver's gain mapping makes `ServoGoals` out of a `JointCommand`; the bus writes them into
registers, and the MuJoCo backend hands them to the same servo physics without the bytes.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

import numpy as np

from hil.interface import AppliedCommand, Floats, Ints, JointCommand, SensorFrame

COUNTS_PER_TURN = 4096
"""X-series position resolution; 2048 is the joint's zero."""
COUNTS_PER_RADIAN = COUNTS_PER_TURN / (2 * np.pi)
CENTRE_COUNTS = 2048
PWM_FULL = 885
"""Goal PWM of 100 % duty."""


class ServoMode(IntEnum):
    """Control modes that a joint can be driven in, by their number in the servo's register."""

    CURRENT = 0
    """Torque by current; stiffness and damping are made on the host."""
    POSITION = 3
    """Stiffness by duty: the motor's back-EMF is its least damping."""
    CURRENT_POSITION = 5
    """Stiffness by current; damping is made on the host."""


JOINT_MODES = {mode.name.lower(): mode for mode in ServoMode}
"""Modes by the name that a robot file has for them."""


@dataclass(slots=True)
class ServoGoals:
    """Register values of one tick, in the servo's own direction, arrays of shape (n,)."""

    position: Ints
    """Goal Position [counts]."""
    p_gain: Ints
    """Position P Gain, register value."""
    d_gain: Ints
    """Position D Gain, register value."""
    pwm_limit: Ints
    """Goal PWM, 0 to 885."""
    current: Ints | None = None
    """Goal Current [counts]: the goal in current mode, the limit in current-based position mode.
    None for a robot whose joints are all in position mode."""


@dataclass(frozen=True, slots=True)
class MotorParameters:
    """Electrical constants of every joint's servo, at the output shaft, arrays of shape (n,)."""

    torque_constant: Floats
    """k_t = back-EMF constant [N·m/A = V·s/rad]."""
    resistance: Floats
    """[Ω]"""
    gain_divisor: Floats
    """Position P Gain register units per internal unit (128 by the e-manual)."""
    direction: Ints
    """+1 or -1: sign of the servo against the joint."""
    current_unit: Floats | None = None
    """[A] of one count of Goal Current; NaN for a servo without it."""
    current_divisor: Floats | None = None
    """Position P Gain register units per current count and position count, in mode 5."""
    size: Floats | None = None
    """Copper and case against those of an 82 g servo, for its heat; none: all are such."""

    def stall_torque(self, voltage: float) -> Floats:
        """Torque at standstill and full duty [N·m], shape (n,)."""
        return self.torque_constant * voltage / self.resistance

    def back_emf_damping(self) -> Floats:
        """Damping of the driven motor, k_t²/R [N·m·s/rad], shape (n,)."""
        return self.torque_constant**2 / self.resistance


class ServoMapping(Protocol):
    """Joint commands to servo registers, the one place where this happens."""

    def map(self, command: JointCommand, frame: SensorFrame) -> tuple[ServoGoals, AppliedCommand]:
        """Goals to write and what they amount to; both objects are reused by the next call."""
        ...
