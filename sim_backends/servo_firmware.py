"""The control loops inside one servo: from its registers to the duty of its bridge."""

import math
from dataclasses import dataclass

import numpy as np

from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN, PWM_FULL, MotorParameters
from sim_backends.motion_profile import VELOCITY_UNIT, MotionProfile

PERIOD = 0.001
"""Sample time of the firmware's loops [s]; assumed: ROBOTIS does not publish it."""
I_DIVISOR, D_DIVISOR, FEED_FORWARD_DIVISOR = 65536.0, 16.0, 4.0
"""Register units per internal unit (X-series e-manual, Position PID Gain)."""
VELOCITY_P_DIVISOR, VELOCITY_I_DIVISOR = 128.0, 65536.0
"""(X-series e-manual, Velocity PI Gain)"""
SLOPE_UNIT = 1.977
"""[V/s] of one PWM Slope unit (XL330 e-manual, PWM Slope: 1.977 mV/ms)."""
CURRENT_UNIT = 0.00269
"""[A] of one current count of the XM, XH and XD series (e-manual), where nothing else is said."""
CURRENT, VELOCITY, POSITION, EXTENDED, CURRENT_POSITION, PWM = 0, 1, 3, 4, 5, 16
"""Operating modes (X-series e-manual, Operating Mode)."""


def senses_supply(servo: str) -> bool:
    """Whether a model measures the current of its supply (XL330 and XC330 e-manuals, notes)."""
    return servo.startswith(("XL330", "XC330"))


@dataclass(frozen=True, slots=True)
class ServoConstants:
    """What one servo's firmware and motor are made of."""

    torque_constant: float
    """k [N·m/A = V·s/rad]."""
    gain_divisor: float
    """Position P Gain units per internal unit."""
    current_divisor: float
    """The same in mode 5, per current count."""
    current_unit: float
    """[A] of one current count."""
    senses_supply: bool
    """Measures and regulates the current of its supply, not that of its motor."""


class ServoFirmware:
    """Registers of one servo's loops, and what they do in one substep of length dt.

    With encoder c, trajectory c* (`MotionProfile`), T the sample time, e = c* − c:

        modes 3, 4   PWM = P·e/D + I·Σe/65536 − K_D·T·ċ/16 + F₁·T·ċ*/4 + F₂·T²·c̈*/4
        mode 5       current counts = the same · D/D₅, within ±Goal Current, then as mode 0
        mode 0       current i* = Goal Current, made by u·V = r·i* + k·ω
        mode 1       PWM = P_v·e_v/128 + I_v·Σe_v/65536, e_v in 0.229 rev/min
        mode 16      PWM = Goal PWM

    always within the PWM limit and, but for mode 16, Goal PWM. Sources: X-series e-manual, the
    block diagrams of each mode. Assumed: T; units of the feed-forward terms (counts per T and T²)
    and of Σ (one term per T); that an integral stops at full output; and that the current loop is
    ideal up to the supply's voltage. A servo that measures its supply's current regulates u·i
    instead: u = (kω + √((kω)² + 4·V·r·i*))/(2V).
    """

    def __init__(self, constants: ServoConstants, timestep: float) -> None:
        self.constants = constants
        self.profile = MotionProfile(timestep)
        self.profile.restart(float(CENTRE_COUNTS))
        self._dt = timestep
        self.mode = POSITION
        self.p_gain, self.i_gain, self.d_gain, self.feed_forward_1, self.feed_forward_2 = (0,) * 5
        self.velocity_p_gain, self.velocity_i_gain = 0, 0
        self.pwm_limit, self.goal_pwm = PWM_FULL, PWM_FULL
        self.current_limit, self.goal_current = math.inf, 0.0
        """[counts]"""
        self.goal_velocity = 0.0
        """[0.229 rev/min]"""
        self.pwm_slope: int | None = None
        """None for a model without slope."""
        self._sum, self._duty = 0.0, 0.0

    @property
    def plain(self) -> bool:
        """Position control by P and D gain alone, which needs no state."""
        return (
            self.mode in (POSITION, EXTENDED)
            and not (self.i_gain or self.feed_forward_1 or self.feed_forward_2)
            and self.profile.steps
            and self.pwm_slope is None
        )

    @property
    def limit(self) -> float:
        """Largest duty."""
        own = self.pwm_limit if self.mode == PWM else min(self.pwm_limit, abs(self.goal_pwm))
        return own / PWM_FULL

    def restart(self, position: float) -> None:
        """Begin anew at rest at a position [counts]."""
        self.profile.restart(position)
        self._sum = self._duty = 0.0

    def duty(
        self, count: float, speed: float, spin: float, goal: float, supply: float, resistance: float
    ) -> float:
        """Share of the supply on the terminals in this substep.

        Encoder [counts], its speed and the rotor's [rad/s], goal [counts], supply [V], hot
        winding [Ω], all in the servo's own direction.
        """
        high, mode = self.limit, self.mode
        if mode == PWM:
            duty = self.goal_pwm / PWM_FULL
        elif mode == VELOCITY:
            duty = self._by_velocity(speed, high)
        elif mode == CURRENT:
            duty = self._by_current(self.goal_current, spin, supply, resistance)
        elif mode == CURRENT_POSITION:
            most = min(self.current_limit, abs(self.goal_current))
            ratio = self.constants.gain_divisor / self.constants.current_divisor
            wanted = ratio * self._by_position(count, speed, goal, most / ratio)
            duty = self._by_current(min(max(wanted, -most), most), spin, supply, resistance)
        else:
            duty = self._by_position(count, speed, goal, high * PWM_FULL) / PWM_FULL
        duty = min(max(duty, -high), high)
        if self.pwm_slope is not None and supply > 0.0:
            rise = SLOPE_UNIT * self.pwm_slope * self._dt / supply
            duty = min(max(duty, self._duty - rise), self._duty + rise)
        self._duty = duty
        return duty

    def _by_position(self, count: float, speed: float, goal: float, most: float) -> float:
        """Output of the position loop [PWM counts]; its integral stays within ±`most`."""
        profile = self.profile
        if goal != profile.goal:
            profile.aim(goal)
        acceleration = profile.advance()
        error = profile.position - count
        output = self.p_gain * error / self.constants.gain_divisor
        output -= self.d_gain * PERIOD * speed * COUNTS_PER_RADIAN / D_DIVISOR
        output += self.feed_forward_1 * PERIOD * profile.velocity / FEED_FORWARD_DIVISOR
        output += self.feed_forward_2 * PERIOD**2 * acceleration / FEED_FORWARD_DIVISOR
        return output + self._integrate(error, self.i_gain / I_DIVISOR, most)

    def _by_velocity(self, speed: float, high: float) -> float:
        profile = self.profile
        profile.advance_velocity(self.goal_velocity * VELOCITY_UNIT)
        error = (profile.velocity - speed * COUNTS_PER_RADIAN) / VELOCITY_UNIT
        output = self.velocity_p_gain * error / VELOCITY_P_DIVISOR
        gain = self.velocity_i_gain / VELOCITY_I_DIVISOR
        return (output + self._integrate(error, gain, high * PWM_FULL)) / PWM_FULL

    def _integrate(self, error: float, gain: float, most: float) -> float:
        if not gain:
            self._sum = 0.0
            return 0.0
        self._sum = min(max(self._sum + error * self._dt / PERIOD, -most / gain), most / gain)
        return gain * self._sum

    def _by_current(self, counts: float, spin: float, supply: float, resistance: float) -> float:
        """Duty that makes a current, given in counts."""
        if supply <= 0.0:
            return 0.0
        most = self.current_limit
        current = min(max(counts, -most), most) * self.constants.current_unit
        back_emf = self.constants.torque_constant * spin
        if not self.constants.senses_supply:
            return (resistance * current + back_emf) / supply
        if current == 0.0:
            return back_emf / supply
        side = math.copysign(1.0, current)
        root = math.sqrt(back_emf * back_emf + 4.0 * supply * resistance * abs(current))
        return side * (side * back_emf + root) / (2.0 * supply)

    def trajectory(self) -> tuple[int, int]:
        """Velocity [0.229 rev/min] and position [counts] of the trajectory."""
        profile = self.profile
        return round(profile.velocity / VELOCITY_UNIT), round(profile.position)


def servo_constants(motors: MotorParameters, senses_supply: list[bool]) -> list[ServoConstants]:
    """Constants of n servos; `senses_supply`: which of them measure their supply's current."""
    n = motors.direction.size
    unit = np.full(n, np.nan) if motors.current_unit is None else motors.current_unit
    divisor = np.full(n, np.nan) if motors.current_divisor is None else motors.current_divisor
    columns = (
        motors.torque_constant, motors.gain_divisor,
        np.where(np.isnan(divisor), motors.gain_divisor, divisor),
        np.where(np.isnan(unit), CURRENT_UNIT, unit),
    )  # fmt: skip
    rows = zip(*(column.tolist() for column in columns), senses_supply, strict=True)
    return [ServoConstants(*row) for row in rows]
