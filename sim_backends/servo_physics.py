"""The servos of a robot as electrical machines: from goals to terminal voltages."""

from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hil.interface import Floats
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN, MotorParameters, ServoGoals
from sim_backends.gear_friction import GearFriction
from sim_backends.pack_supply import PackSupply
from sim_backends.servo_figures import ServoTotals
from sim_backends.servo_firmware import PERIOD, ServoFirmware, servo_constants
from sim_backends.servo_heat import ServoHeat
from sim_backends.servo_protection import ServoProtection

OPEN_CIRCUIT = 1e12
"""Resistance of a motor whose bridge is off [Ω]."""
BLOCK = 128
"""Substeps, some 100 ms, after which heat, protection and totals look at what was."""
_D_GAIN = PERIOD * COUNTS_PER_RADIAN / (16.0 * 885.0)


class Measured(NamedTuple):
    """What n servos measure at one grid point, in their own directions."""

    counts: list[float]
    """Encoders [counts], whole numbers."""
    velocity: list[float]
    """[rad/s]"""
    duty: list[float]
    """Share of the supply on the terminals."""
    current: list[float]
    """Of the motor [A]."""


@dataclass(frozen=True, slots=True)
class MotorPort:
    """The motors in MuJoCo: views of its arrays, shape (n,), in joint direction."""

    resistance: Floats
    """Of the dcmotors [Ω], written when torque goes on or off and as windings warm."""
    voltage: Floats
    """At their terminals [V], written by `drive`."""


class ServoPhysics:
    """n servos on one supply, stepped once a physics substep.

    With encoder counts c = round(s·q·4096/2π + 2048 + c₀) of the joint angle q, goal c*, gain P,
    PWM limit L and rotor speed ω (q̇ where there is no backlash):

        duty    u = clip((P/D)·(c* − c)/885 − (P_D/16)·T·ċ/885, ±L/885)
        voltage v = u·V,   V = V₀ − R·Σ u·i    (the sum of the substep before)
        current i = (v − k·ω)/r,               torque k·i

    (X-series e-manual, Position Control Mode and Position PID Gain: D = 128, P_D over 16.) A servo
    that uses more of its firmware than this has its duty from `ServoFirmware`. The joint torque
    itself is MuJoCo's `dcmotor`, which gets v; here i is for supply, readings, heat and totals.
    With torque off the bridge is open: no voltage and no back-EMF current, so the joint turns
    freely against its friction (X-series servos can be back-driven by hand then).
    """

    def __init__(
        self,
        motors: MotorParameters,
        supply: PackSupply,
        timestep: float,
        port: MotorPort,
        encoder_offset: Floats,
        senses_supply: list[bool],
    ) -> None:
        """`encoder_offset`: what each encoder shows too much, (n,) [counts]; `senses_supply`:
        servos that measure the current of their supply."""
        n = motors.direction.size
        self.motors, self.supply = motors, supply
        self._timestep, self._port = timestep, port
        self._sign = motors.direction.astype(np.float64)
        self._zero = CENTRE_COUNTS + encoder_offset
        self._senses_supply = np.array(senses_supply)
        self.enabled = np.zeros(n, dtype=np.bool_)
        self.goal = np.full(n, float(CENTRE_COUNTS))
        """Position goal [counts], shape (n,)."""
        self.firmware = [
            ServoFirmware(constants, timestep)
            for constants in servo_constants(motors, senses_supply)
        ]
        """Registers of every servo's loops; call `refresh` after changing one."""
        self.friction: GearFriction | None = None
        """Friction that changes; none is MuJoCo's constant one."""
        self.heat = ServoHeat(motors.resistance, motors.size)
        self.protection = ServoProtection(n)
        self._late: deque[list[float]] = deque()
        self._gains = (b"", b"", b"")
        self._stall_current = supply.voltage / motors.resistance
        self._full = np.full(n, np.inf)
        self._rows: list[tuple[float, ...]] = []
        self._loops: list[ServoFirmware | None] = []
        self._stale = True
        self.measured = Measured(*([0.0] * n for _ in range(4)))
        """What the servos measured when `drive` was called last."""
        self.measured_voltage = supply.voltage
        """Supply as the servos' slow registers show it [V]: mean of a block."""
        self._kept: list[Measured] = []
        self._substeps = 0
        self._square_sum, self._saturated = np.zeros(n), np.zeros(n)
        self._degrees = [round(degrees) for degrees in self.heat.case.tolist()]
        self._port.resistance[:] = OPEN_CIRCUIT

    # Goals -----------------------------------------------------------------------------------

    def set_goals(self, goals: ServoGoals) -> None:
        """Adopt the goals of every servo; they act from the next call of `drive`."""
        self.goal[:] = goals.position
        if goals.current is not None:
            for firmware, current in zip(self.firmware, goals.current.tolist(), strict=True):
                firmware.goal_current = current
        gains = (goals.p_gain.tobytes(), goals.d_gain.tobytes(), goals.pwm_limit.tobytes())
        if gains == self._gains:
            return
        self._gains = gains
        columns = (goals.p_gain.tolist(), goals.d_gain.tolist(), goals.pwm_limit.tolist())
        for firmware, p_gain, d_gain, pwm in zip(self.firmware, *columns, strict=True):
            firmware.p_gain, firmware.d_gain, firmware.goal_pwm = p_gain, d_gain, pwm
        self._stale = True

    def refresh(self) -> None:
        """Registers of a servo have changed."""
        self._gains = (b"", b"", b"")
        self._stale = True

    def delay_goals(self, substeps: int) -> None:
        """From now on goals act so many substeps later."""
        self._late = deque([self.goal.tolist()] * substeps)

    def set_enabled(self, servo: int, on: bool) -> None:
        """Torque of one servo on, or its terminals open; it stays off after a shutdown."""
        on = on and servo not in self.protection.tripped()
        if on and not self.enabled[servo]:
            self.firmware[servo].restart(self.measured.counts[servo])
            for goals in self._late:
                goals[servo] = float(self.goal[servo])
        self.enabled[servo] = on
        self._stale = True

    def put_on_horn(self, servo: int, turned: float) -> None:
        """Mount a servo whose joint is at zero when it shows so much beside its middle [rad]."""
        self._zero[servo] += self._sign[servo] * turned * COUNTS_PER_RADIAN
        self._stale = True

    def reboot(self, servo: int) -> None:
        """Torque off, and errors forgotten."""
        self.set_enabled(servo, False)
        self.protection.reboot(servo)

    def _collect(self) -> None:
        """Collect the constants of every servo for `drive`."""
        on, firmware = self.enabled, self.firmware
        self._loops = [None if own.plain else own for own in firmware]
        high = np.array([own.limit for own in firmware]) * on
        full = np.where(high > 0, high, np.inf)
        if not np.array_equal(full, self._full):
            self._account()
            self._full = full
        divisor = self.motors.gain_divisor * 885.0
        resistance = self.heat.resistance
        rows = (
            self._sign, self._sign * COUNTS_PER_RADIAN, self._zero,
            np.array([own.p_gain for own in firmware]) / divisor,
            np.array([own.d_gain for own in firmware]) * _D_GAIN, high,
            self._sign * self.motors.torque_constant, on / resistance,
        )  # fmt: skip
        self._rows = [tuple(row) for row in np.transpose(rows).tolist()]
        self._port.resistance[:] = np.where(on, resistance, OPEN_CIRCUIT)
        self._stale = False

    # One substep -----------------------------------------------------------------------------

    def drive(self, position: Floats, velocity: Floats, spin: Floats) -> Floats:
        """Terminal voltages in joint direction [V], (n,), for the substep that begins now.

        Joint positions [rad] and velocities, rotor velocities [rad/s], (n,). Runs in every
        substep: for a dozen servos plain floats are faster than arrays.
        """
        if self._stale:
            self._collect()
        supply, supply_current = self.supply.voltage, 0.0
        goals, spins = self.goal.tolist(), spin.tolist()
        if self._late:
            self._late.append(goals)
            goals = self._late.popleft()
        voltages: list[float] = []
        measured = Measured([], [], [], [])
        counts, speeds, duties, currents = measured
        for angle, rate, turn, goal, loop, (sign, scale, zero, p, d, high, k, conductance) in zip(
            position.tolist(), velocity.tolist(), spins, goals, self._loops, self._rows,
            strict=True,
        ):  # fmt: skip
            count = round(angle * scale + zero)
            speed = rate * sign
            if loop is None:
                duty = (goal - count) * p - d * speed
                if duty > high:
                    duty = high
                elif duty < -high:
                    duty = -high
            elif conductance:
                duty = loop.duty(count, speed, turn * sign, goal, supply, 1.0 / conductance)
            else:
                duty = 0.0
            voltage = duty * supply
            current = (voltage - turn * k) * conductance
            supply_current += duty * current
            voltages.append(voltage * sign)
            counts.append(count)
            speeds.append(speed)
            duties.append(duty)
            currents.append(current)
        self._port.voltage[:] = voltages
        self.supply.load(supply_current)
        self.measured = measured
        if self.friction is not None:
            self.friction.act(spins, currents)
        self._kept.append(measured)
        if len(self._kept) == BLOCK:
            self._account()
        return self._port.voltage

    def _account(self) -> None:
        """Heat, protection and totals of what is kept."""
        substeps = len(self._kept)
        if not substeps:
            return
        currents = np.array([measured.current for measured in self._kept])
        duties = np.array([measured.duty for measured in self._kept])
        self._kept.clear()
        squares = np.square(currents).sum(axis=0)
        self._substeps += substeps
        self._square_sum += squares
        self._saturated += (np.abs(duties) >= self._full).sum(axis=0)
        duration = substeps * self._timestep
        self.measured_voltage = self.supply.mean()
        self.heat.advance(squares / substeps, duration)
        load = np.abs(currents).mean(axis=0) / self._stall_current
        self.protection.judge(load, self.heat.case, self.measured_voltage, duration)
        self._degrees = [round(degrees) for degrees in self.heat.case.tolist()]
        self._stale = True
        for servo in self.protection.tripped():
            self.enabled[servo] = False

    # Readings --------------------------------------------------------------------------------

    @property
    def voltage(self) -> float:
        """Supply at the servos [V]."""
        return self.supply.voltage

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

    @property
    def sensed_current(self) -> Floats:
        """What the servos measure: some models the current of their supply [A], shape (n,)."""
        current = self.current
        return np.where(self._senses_supply, self.duty * current, current)

    def torque(self) -> Floats:
        """Motor torque in joint direction [N·m], shape (n,)."""
        torque: Floats = self.current * self._sign * self.motors.torque_constant
        return torque

    def degrees(self) -> list[int]:
        """Case temperatures of the last block as whole °C."""
        return self._degrees

    def totals(self) -> ServoTotals:
        """Extremes and sums since the start."""
        self._account()
        steps = max(self._substeps, 1)
        return ServoTotals(
            self.heat.highest,
            np.sqrt(self._square_sum / steps) / self._stall_current,
            self._saturated / steps,
            self.supply.lowest,
            self.supply.energy * self._timestep,
        )
