"""The position servos of a robot as electrical machines: from goals to terminal voltages."""

from typing import NamedTuple

import numpy as np

from hil.description import Supply
from hil.interface import Floats
from hil.servo import (
    CENTRE_COUNTS,
    COUNTS_PER_RADIAN,
    PWM_FULL,
    MotorParameters,
    ServoGoals,
)
from sim_backends.servo_figures import ServoTotals

D_DIVISOR = 16.0
"""Position D Gain register units per internal unit (X-series e-manual, Position PID Gain)."""
D_PERIOD = 0.001
"""Sample time of the servo's own loop [s]; assumed: ROBOTIS does not publish it."""
OPEN_CIRCUIT = 1e12
"""Resistance of a motor whose bridge is off [Ω]."""
AMBIENT = 25.0
"""[°C]"""
THERMAL_RESISTANCE = 5.0
"""Winding to surroundings [K/W]; assumed."""
THERMAL_TIME = 400.0
"""Time constant of the servo's case [s]; assumed."""
TEMPERATURE_SUBSTEPS = 100
"""Substeps between two looks at temperatures, which change in seconds."""
_KEPT = 64
"""Substeps whose duties and currents are kept before they are added to the totals."""


class Measured(NamedTuple):
    """What n servos measure at one grid point, in their own directions."""

    counts: list[float]
    """Encoders [counts], whole numbers."""
    velocity: list[float]
    """[rad/s]"""
    duty: list[float]
    """Share of the supply on the terminals."""
    current: list[float]
    """[A]"""


class ServoPhysics:
    """n position servos on one supply, stepped once a physics substep.

    With encoder counts c = round(s·(q)·4096/2π + 2048), goal c*, gain P and PWM limit L:

        duty    u = clip((P/D)·(c* − c)/885 − (P_D/16)·T·ċ/885, ±L/885)
        voltage v = u·V,   V = V₀ − R·Σ u·i    (the sum of the substep before)
        current i = (v − k·q̇)/r,               torque k·i

    (X-series e-manual, Position Control Mode and Position PID Gain: D = 128, P_D over 16.)
    The joint torque itself is MuJoCo's `dcmotor`, which gets v; here i is for the supply, the
    readings and the totals. With torque off the bridge is open: no voltage and no back-EMF
    current, so the joint turns freely against its friction (X-series servos can be
    back-driven by hand then). Heat is one thermal mass a servo, figures assumed.
    """

    def __init__(
        self,
        motors: MotorParameters,
        supply: Supply,
        timestep: float,
        terminal_resistance: Floats,
        terminal_voltage: Floats,
        encoder_phase: Floats,
    ) -> None:
        """`terminal_resistance`: the dcmotors' own, (n,), written when torque goes on or off.

        `terminal_voltage`: their inputs in joint direction [V], (n,), written by `drive`.
        `encoder_phase`: where in a count each encoder's zero lies, (n,) [counts].
        """
        n = motors.direction.size
        self.motors = motors
        self.supply = supply
        self._timestep = timestep
        self._terminal = terminal_resistance
        self._terminal_voltage = terminal_voltage
        self._sign = motors.direction.astype(np.float64)
        self._zero = CENTRE_COUNTS + encoder_phase
        self.enabled = np.zeros(n, dtype=np.bool_)
        self.goal = np.full(n, float(CENTRE_COUNTS))
        """Position goal [counts], shape (n,)."""
        self._p_gain, self._d_gain = np.zeros(n), np.zeros(n)
        self._limit, self._conductance = np.zeros(n), np.zeros(n)
        self._gains = (b"", b"", b"")
        self._back_emf = self._sign * motors.torque_constant
        self._full = np.full(n, np.inf)
        self._constants: list[tuple[float, ...]] = []
        self._stale = True
        self.measured = Measured(*([0.0] * n for _ in range(4)))
        """What the servos measured when `drive` was called last."""
        self.voltage = supply.voltage
        """Supply at the servos [V]."""
        self._reset_totals(n)
        self._terminal[:] = OPEN_CIRCUIT

    def _reset_totals(self, n: int) -> None:
        self._substeps = 0
        self._kept: list[Measured] = []
        self._square_sum, self._heated = np.zeros(n), np.zeros(n)
        self._saturated = np.zeros(n)
        self._temperature = np.full(n, AMBIENT)
        self._cooled_at = 0
        self._look_at = 0
        self._degrees = [round(AMBIENT)] * n
        self._temperature_max = AMBIENT
        self._voltage_min = self.supply.voltage
        self._energy = 0.0

    # Goals -----------------------------------------------------------------------------------

    def set_goals(self, goals: ServoGoals) -> None:
        """Adopt the goals of every servo; they act from the next call of `drive`."""
        self.goal[:] = goals.position
        gains = (goals.p_gain.tobytes(), goals.d_gain.tobytes(), goals.pwm_limit.tobytes())
        if gains == self._gains:
            return
        self._gains = gains
        np.divide(goals.p_gain, self.motors.gain_divisor * PWM_FULL, out=self._p_gain)
        np.multiply(goals.d_gain, D_PERIOD / (D_DIVISOR * PWM_FULL), out=self._d_gain)
        np.multiply(goals.pwm_limit, 1.0 / PWM_FULL, out=self._limit)
        self._stale = True

    def set_gains(self, servo: int, p_gain: int, d_gain: int, pwm_limit: int) -> None:
        """Gains and PWM limit of one servo, as register values."""
        self._gains = (b"", b"", b"")
        self._p_gain[servo] = p_gain / (self.motors.gain_divisor[servo] * PWM_FULL)
        self._d_gain[servo] = d_gain * D_PERIOD / (D_DIVISOR * PWM_FULL)
        self._limit[servo] = pwm_limit / PWM_FULL
        self._stale = True

    def set_enabled(self, servo: int, on: bool) -> None:
        """Torque of one servo on, or its terminals open."""
        resistance = float(self.motors.resistance[servo])
        self.enabled[servo] = on
        self._conductance[servo] = 1.0 / resistance if on else 0.0
        self._terminal[servo] = resistance if on else OPEN_CIRCUIT
        self._stale = True

    def _refresh(self) -> None:
        """Collect the constants of every servo for `drive`."""
        high = self._limit * self.enabled
        full = np.where(high > 0, high, np.inf)
        if not np.array_equal(full, self._full):
            self._account()
            self._full = full
        scale = self._sign * COUNTS_PER_RADIAN
        rows = (
            self._sign, scale, self._zero, self._p_gain, self._d_gain * COUNTS_PER_RADIAN, high,
            self.motors.torque_constant, self._conductance,
        )  # fmt: skip
        self._constants = [tuple(row) for row in np.transpose(rows).tolist()]
        self._stale = False

    # One substep -----------------------------------------------------------------------------

    def drive(self, position: Floats, velocity: Floats) -> Floats:
        """Terminal voltages in joint direction [V], (n,), for the substep that begins now.

        Runs in every substep: for a dozen servos plain floats are faster than arrays.
        """
        if self._stale:
            self._refresh()
        supply, supply_current = self.voltage, 0.0
        voltages: list[float] = []
        measured = Measured([], [], [], [])
        counts, speeds, duties, currents = measured
        for angle, rate, goal, (sign, scale, zero, p, d, high, k, conductance) in zip(
            position.tolist(), velocity.tolist(), self.goal.tolist(), self._constants, strict=True
        ):
            count = round(angle * scale + zero)
            speed = rate * sign
            duty = (goal - count) * p - d * speed
            if duty > high:
                duty = high
            elif duty < -high:
                duty = -high
            voltage = duty * supply
            current = (voltage - speed * k) * conductance
            supply_current += duty * current
            voltages.append(voltage * sign)
            counts.append(count)
            speeds.append(speed)
            duties.append(duty)
            currents.append(current)
        self._terminal_voltage[:] = voltages
        self._load_supply(supply_current)
        self.measured = measured
        self._kept.append(measured)
        if len(self._kept) == _KEPT:
            self._account()
        return self._terminal_voltage

    def _load_supply(self, current: float) -> None:
        """Sag and energy of a supply that gives a current [A]."""
        self._energy += self.voltage * current
        self.voltage = voltage = self.supply.voltage - self.supply.resistance * current
        if voltage < self._voltage_min:
            self._voltage_min = voltage

    def _account(self) -> None:
        """Add what is kept to the totals."""
        if not self._kept:
            return
        self._substeps += len(self._kept)
        currents = np.array([measured.current for measured in self._kept])
        duties = np.array([measured.duty for measured in self._kept])
        self._square_sum += np.square(currents).sum(axis=0)
        self._saturated += (np.abs(duties) >= self._full).sum(axis=0)
        self._kept.clear()

    # Readings --------------------------------------------------------------------------------

    @property
    def counts(self) -> Floats:
        """Encoder readings [counts], shape (n,)."""
        return np.array(self.measured.counts, dtype=np.float64)

    @property
    def duty(self) -> Floats:
        """Share of the supply on the terminals, in the servo's own direction, shape (n,)."""
        return np.array(self.measured.duty)

    @property
    def current(self) -> Floats:
        """Motor currents in the servo's own direction [A], shape (n,)."""
        return np.array(self.measured.current)

    def torque(self) -> Floats:
        """Motor torque in joint direction, as the current tells it [N·m], shape (n,)."""
        torque: Floats = self.current * self._back_emf
        return torque

    def temperature(self) -> Floats:
        """Case temperatures [°C], shape (n,): copper loss r·i² on one thermal mass each."""
        self._account()
        substeps = self._substeps - self._cooled_at
        if substeps > 0:
            mean_square = (self._square_sum - self._heated) / substeps
            settled = AMBIENT + THERMAL_RESISTANCE * self.motors.resistance * mean_square
            decay = np.exp(-substeps * self._timestep / THERMAL_TIME)
            self._temperature = settled + (self._temperature - settled) * decay
            self._heated[:] = self._square_sum
            self._cooled_at = self._substeps
            self._temperature_max = max(self._temperature_max, float(self._temperature.max()))
        return self._temperature

    def degrees(self) -> list[int]:
        """Case temperatures as whole °C, looked at now and then."""
        substeps = self._substeps + len(self._kept)
        if substeps >= self._look_at:
            self._look_at = substeps + TEMPERATURE_SUBSTEPS
            self._degrees = [round(degrees) for degrees in self.temperature().tolist()]
        return self._degrees

    def totals(self) -> ServoTotals:
        """Extremes and sums since the start."""
        self.temperature()
        steps = max(self._substeps, 1)
        stall_current = self.supply.voltage / self.motors.resistance
        return ServoTotals(
            self._temperature_max,
            np.sqrt(self._square_sum / steps) / stall_current,
            self._saturated / steps,
            self._voltage_min,
            self._energy * self._timestep,
        )
