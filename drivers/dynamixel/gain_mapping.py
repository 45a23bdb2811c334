"""Joint commands to servo registers: the one place where stiffness and torque become counts."""

import numpy as np

from drivers.calibration import RobotCalibration
from drivers.dynamixel.servo_models import ServoModel, find_servo_model
from hil.description import Joint, RobotDescription
from hil.errors import InputError
from hil.interface import AppliedCommand, Bools, Floats, Ints, JointCommand, Limit, SensorFrame
from hil.servo import (
    CENTRE_COUNTS,
    COUNTS_PER_RADIAN,
    COUNTS_PER_TURN,
    PWM_FULL,
    MotorParameters,
    ServoGoals,
)

P_GAIN_MAX = 16383
DAMPING_TOLERANCE = 0.02
"""A damping this close below the motor's own counts as the motor's own."""
DAMPING_MAX_FACTOR = 2.0
"""Largest damping, as a multiple of the motor's own: the rest is made on the host from a delayed
velocity, which must not exceed what two ticks of delay leave stable (assumed)."""
P_GAIN_HYSTERESIS = 0.02
"""The P gain is left alone while it is this close to the wanted one."""
VOLTAGE_FILTER_S = 1.0
"""Time constant of the supply voltage that gains are scaled with."""
VOLTAGE_PERIOD_NS = 20_000_000
"""Between two looks at the measured voltages."""


class GainMapping:
    """Realises a JointCommand with the position controller of an X-series servo.

    In position mode the drive's duty is P·e/D/885 of full supply, e the position error in counts
    and P the Position P Gain. With c counts a radian and the stall torque τ₀ at supply V that is
    a stiffness

        K = P·c/(885·D)·τ₀(V),   τ₀(V) = V·k_t/R,

    beside which the turning motor brakes itself with its back-EMF damping k_free = k_t²/R. The
    asked torque kp·(q* − q) + kd·(q̇* − q̇) + τ then comes out of K·(goal − q) − k_free·q̇ with

        goal = q* + [(k_free − kd)·q̇ + kd·q̇* + τ]/K.

    D gain and I gain stay 0. K counts as what it is after rounding P, so that torque and velocity
    lead are right even where the stiffness is off by the hysteresis of P. The supply is the mean
    of the measured servo voltages, filtered over a second; the robot's nominal voltage until one
    is known. Less damping than the motor's own cannot be had in this mode.

    Sources: ROBOTIS e-manual (position PID gain, divisor 128); datasheet torque-speed line.
    """

    def __init__(self, description: RobotDescription, calibration: RobotCalibration) -> None:
        """Raises InputError for a joint whose range or default gains its servo cannot do."""
        if description.supply is None:
            raise InputError(f"{description.file}: supply: is missing, servo gains depend on it")
        models = [find_servo_model(joint.servo or "") for joint in description.joints]
        n = len(models)
        self._motors = _motor_parameters(description, models)
        self._stall_per_volt = self._motors.torque_constant / self._motors.resistance
        self._own_damping = self._motors.back_emf_damping()
        self._p_scale = self._motors.gain_divisor * PWM_FULL / COUNTS_PER_RADIAN
        self._offset = calibration.offsets(description.joint_names)
        self._counts_per_radian = self._motors.direction * COUNTS_PER_RADIAN
        self._low = np.array([joint.range[0] for joint in description.joints])
        self._high = np.array([joint.range[1] for joint in description.joints])
        self._torque_limit = np.array([joint.torque_limit for joint in description.joints])
        self._voltage = description.supply.voltage
        self._voltage_time_ns: int | None = None
        self._gains_for: tuple[bytes, bytes, float] | None = None
        self._p_gain = np.zeros(n)
        self._divisor = np.ones(n)
        self._extra_damping: Floats | None = None
        self._saturation_error = np.ones(n)
        self._gain_flags: Ints = np.zeros(n, dtype=np.int64)
        self._goals = ServoGoals(
            position=np.full(n, CENTRE_COUNTS, dtype=np.int64),
            p_gain=np.zeros(n, dtype=np.int64),
            d_gain=np.zeros(n, dtype=np.int64),
            pwm_limit=np.full(n, PWM_FULL, dtype=np.int64),
        )
        self._applied = AppliedCommand.zeros(n)
        for index, joint in enumerate(description.joints):
            self._check(joint, index)

    def motor_parameters(self) -> MotorParameters:
        """Nominal electrical constants of every joint's servo."""
        return self._motors

    @property
    def voltage(self) -> float:
        """Supply that gains are scaled with now [V]."""
        return self._voltage

    def map(self, command: JointCommand, frame: SensorFrame) -> tuple[ServoGoals, AppliedCommand]:
        """Goals to write and what they amount to; both objects are reused by the next call."""
        self._follow_voltage(frame)
        key = (command.stiffness.tobytes(), command.damping.tobytes(), self._voltage)
        if key != self._gains_for:
            self._set_gains(command)
            self._gains_for = key
        applied = self._applied
        position = applied.position
        np.minimum(np.maximum(command.position, self._low), self._high, out=position)
        torque = np.minimum(np.maximum(command.torque, -self._torque_limit), self._torque_limit)
        applied.velocity[:] = command.velocity
        lead = applied.damping * command.velocity
        if self._extra_damping is not None:
            lead -= self._extra_damping * frame.joint_velocity

        goal = position + (lead + torque) / self._divisor
        wanted = np.rint((goal + self._offset) * self._counts_per_radian)
        counts = np.minimum(np.maximum(wanted, -CENTRE_COUNTS), CENTRE_COUNTS - 1)
        sent = counts / self._counts_per_radian - self._offset
        np.subtract(applied.stiffness * (sent - position), lead, out=applied.torque)
        np.add(counts, CENTRE_COUNTS, out=self._goals.position, casting="unsafe")

        error = np.abs(sent - frame.joint_position)
        applied.limit[:] = self._gain_flags
        self._flag(Limit.SATURATION, error > self._saturation_error)
        self._flag(Limit.POSITION, (position != command.position) | (counts != wanted))
        self._flag(Limit.TORQUE, torque != command.torque)
        return self._goals, applied

    def _flag(self, limit: Limit, where: Bools) -> None:
        if np.count_nonzero(where):
            self._applied.limit[where] |= int(limit)

    def _follow_voltage(self, frame: SensorFrame) -> None:
        if self._voltage_time_ns is None:
            self._voltage_time_ns = frame.time_ns
        elapsed_ns = frame.time_ns - self._voltage_time_ns
        if elapsed_ns < VOLTAGE_PERIOD_NS:
            return
        self._voltage_time_ns = frame.time_ns
        known = frame.joint_voltage[np.isfinite(frame.joint_voltage)]
        if known.size:
            share = min(1.0, elapsed_ns * 1e-9 / VOLTAGE_FILTER_S)
            self._voltage += share * (float(known.mean()) - self._voltage)

    def _set_gains(self, command: JointCommand) -> None:
        """What depends on stiffness, damping and supply only, and so rarely changes."""
        applied = self._applied
        per_count = self._stall_per_volt * (self._voltage / self._p_scale)
        wanted = np.rint(np.clip(command.stiffness / per_count, 0, P_GAIN_MAX))
        change = np.abs(wanted - self._p_gain) > P_GAIN_HYSTERESIS * self._p_gain
        np.copyto(self._p_gain, wanted, where=change)
        self._goals.p_gain[:] = self._p_gain
        np.multiply(self._p_gain, per_count, out=applied.stiffness)
        np.maximum(applied.stiffness, per_count, out=self._divisor)
        self._saturation_error = self._p_scale / np.maximum(self._p_gain, 1)

        own = self._own_damping
        np.clip(command.damping, own, DAMPING_MAX_FACTOR * own, out=applied.damping)
        extra = applied.damping - own
        self._extra_damping = extra if extra.any() else None
        too_low = command.damping < (1 - DAMPING_TOLERANCE) * own
        damping_off = too_low | (command.damping > applied.damping)
        off = np.abs(applied.stiffness - command.stiffness)
        stiffness_off = off > 2 * P_GAIN_HYSTERESIS * command.stiffness
        self._gain_flags = damping_off.astype(np.int64) * int(Limit.DAMPING)
        self._gain_flags += stiffness_off.astype(np.int64) * int(Limit.STIFFNESS)

    def _check(self, joint: Joint, index: int) -> None:
        own = float(self._own_damping[index])
        least = float(self._stall_per_volt[index] * self._voltage / self._p_scale[index])
        _require(joint, "stiffness", joint.stiffness, least, least * P_GAIN_MAX, "N·m/rad")
        low = own * (1 - DAMPING_TOLERANCE)
        _require(joint, "damping", joint.damping, low, own * DAMPING_MAX_FACTOR, "N·m·s/rad")
        ends = [(q + self._offset[index]) * COUNTS_PER_RADIAN for q in joint.range]
        half_turn = COUNTS_PER_TURN / 2
        if min(ends) < -half_turn or max(ends) >= half_turn:
            raise InputError(
                f"joint {joint.name}: range {joint.range} with offset "
                f"{self._offset[index]:.3f} rad leaves the servo's single turn (±3.14 rad)"
            )


def _require(joint: Joint, key: str, value: float, low: float, high: float, unit: str) -> None:
    if not low <= value <= high:
        raise InputError(
            f"joint {joint.name}: {joint.servo} cannot have {key} {value:g} {unit}; "
            f"feasible: {low:.3g} to {high:.3g}"
        )


def _motor_parameters(description: RobotDescription, models: list[ServoModel]) -> MotorParameters:
    direction: Ints = np.array([joint.direction for joint in description.joints])
    return MotorParameters(
        torque_constant=np.array([model.torque_constant for model in models]),
        resistance=np.array([model.resistance for model in models]),
        gain_divisor=np.array([float(model.gain_divisor) for model in models]),
        direction=direction,
    )
