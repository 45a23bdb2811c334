"""Joint commands to servo registers: the one place where stiffness and torque become counts."""

from dataclasses import replace

import numpy as np

from drivers.assembly import bus_budgets
from drivers.calibration import RobotCalibration
from drivers.dynamixel.current_mode import HostStiffness
from drivers.dynamixel.gain_limits import (
    DAMPING_MAX_FACTOR,
    DAMPING_TOLERANCE,
    P_GAIN_MAX,
    current_stiffness,
    feasible,
    position_stiffness,
    require_feasible,
    require_mode,
    require_single_turn,
)
from drivers.dynamixel.learned_motors import LearnedMotors
from drivers.dynamixel.prediction import JointPrediction
from drivers.dynamixel.servo_models import find_servo_model
from drivers.motor_constants import motor_parameters
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import AppliedCommand, Bools, Floats, Ints, JointCommand, Limit, SensorFrame
from hil.servo import (
    CENTRE_COUNTS,
    COUNTS_PER_RADIAN,
    PWM_FULL,
    MotorParameters,
    ServoGoals,
    ServoMode,
)

P_GAIN_HYSTERESIS = 0.02
"""The P gain is left alone while it is this close to the wanted one."""
VOLTAGE_FILTER_S = 1.0
"""Time constant of the supply voltage that gains are scaled with."""
VOLTAGE_PERIOD_NS = 20_000_000
"""Between two looks at the measured voltages."""


class GainMapping:
    """Realises a JointCommand with the controllers of an X-series servo.

    Position mode (3): the drive's duty is P·e/D/885 of full supply, e the position error in counts
    and P the Position P Gain. With c counts a radian and the stall torque τ₀ at supply V that is

        K = P·c/(885·D)·τ₀(V),   τ₀(V) = V·k_t/R,

    beside which the turning motor brakes itself with its back-EMF damping k_free = k_t²/R.
    Current-based position mode (5): the same PID asks for a current, which is regulated, so that
    K = P·c/D₅·I₁·k_t, whatever the supply, and k_free = 0. In both, the asked torque
    kp·(q* − q) + kd·(q̇* − q̇) + τ comes out of K·(goal − q) − k_free·q̇ with

        goal = q* + [(k_free − kd)·q̂̇ + kd·q̇* + τ]/K,

    q̂̇ being the velocity when the goal acts (`JointPrediction`). Current mode (0): `HostStiffness`.
    D gain and I gain stay 0. K counts as what it is after rounding P, so that torque and velocity
    lead are right even where the stiffness is off by the hysteresis of P. The supply is the mean
    of the measured servo voltages, filtered over a second; the robot's nominal voltage until one
    is known.

    Constants are the calibration's where the servo was identified, else the data sheet's; a
    robot all of whose joints are in position mode and measure current goes on learning them
    (`LearnedMotors`).
    Sources: ROBOTIS e-manual (position PID gain, divisor 128); datasheet torque-speed line.
    """

    def __init__(self, description: RobotDescription, calibration: RobotCalibration) -> None:
        """Raises InputError for a joint whose range or default gains its servo cannot do."""
        if description.supply is None:
            raise InputError(f"{description.file}: supply: is missing, servo gains depend on it")
        n = len(description.joints)
        self._voltage = description.supply.voltage
        self._voltage_time_ns: int | None = None
        self._motors = motor_parameters(description, calibration)
        modes = np.array([require_mode(joint) for joint in description.joints])
        # A robot file is written for its data sheets: what was identified clamps, but refuses not.
        nominal = motor_parameters(description, calibration.model_copy(update={"servos": {}}))
        self._adopt_modes(description, modes, nominal)
        self._by_duty = modes == ServoMode.POSITION
        self._learned: LearnedMotors | None = None
        units = self._motors.current_unit
        if self._by_duty.all() and units is not None and np.isfinite(units).all():
            self._learned = LearnedMotors(self._motors, description.defaults.rate_hz)
        self._sent = np.full(n, np.nan)
        self._offset = calibration.offsets(description.joint_names)
        self._counts_per_radian = self._motors.direction * COUNTS_PER_RADIAN
        self._low, self._high = calibration.ranges(description)
        self._torque_limit = np.array([joint.torque_limit for joint in description.joints])
        self._gains_for: tuple[bytes, bytes, float] | None = None
        self._p_gain = np.zeros(n)
        self._divisor = np.ones(n)
        self._extra_damping: Floats | None = None
        self._saturation_error = np.ones(n)
        self._gain_flags: Ints = np.zeros(n, dtype=np.int64)
        self._applied = AppliedCommand.zeros(n)
        self._goals = ServoGoals(
            position=np.full(n, CENTRE_COUNTS, dtype=np.int64),
            p_gain=np.zeros(n, dtype=np.int64),
            d_gain=np.zeros(n, dtype=np.int64),
            pwm_limit=np.full(n, PWM_FULL, dtype=np.int64),
            current=None if (modes == ServoMode.POSITION).all() else self._rest_current.copy(),
        )
        self._applied.goal, self._applied.p_gain = self._sent, self._goals.p_gain
        for offset, joint in zip(self._offset.tolist(), description.joints, strict=True):
            require_single_turn(joint, offset)

    def _adopt_modes(
        self, description: RobotDescription, modes: Ints, nominal: MotorParameters
    ) -> None:
        """What follows from each joint's mode. Raises InputError for infeasible gains."""
        motors, joints = self._motors, description.joints
        by_duty = modes == ServoMode.POSITION
        self._adopt_constants(motors, by_duty)
        self._per_current = np.where(by_duty, 0.0, np.nan_to_num(current_stiffness(motors)))
        limit = current_limits(description, motors)
        # Full effort: all duty, or all the current that the joint may have.
        effort = np.where(by_duty, PWM_FULL * motors.gain_divisor, 0.0)
        if motors.current_divisor is not None:
            effort += np.where(by_duty, 0.0, limit * np.nan_to_num(motors.current_divisor))
        self._full_effort = effort / COUNTS_PER_RADIAN
        self._rest_current = np.where(modes == ServoMode.CURRENT_POSITION, limit, 0)
        latency_s = 1e-9 * max(budget.needed_ns for budget in bus_budgets(description))
        self._ahead = JointPrediction(len(joints), latency_s)
        delay_s = latency_s + 0.5 / description.defaults.rate_hz
        most = []
        for index, (joint, number) in enumerate(zip(joints, modes.tolist(), strict=True)):
            mode = ServoMode(number)
            require_feasible(joint, feasible(nominal, index, mode, self._voltage, delay_s))
            most.append(feasible(motors, index, mode, self._voltage, delay_s).stiffness[1])
        self._most_stiffness = np.array(most)
        self._host_joints = np.flatnonzero(modes == ServoMode.CURRENT)
        self._host: HostStiffness | None = None
        if self._host_joints.size:
            self._host = HostStiffness(self._host_joints, motors, limit)

    def _adopt_constants(self, motors: MotorParameters, by_duty: Bools) -> None:
        self._own_damping = np.where(by_duty, motors.back_emf_damping(), 0.0)
        self._most_damping = DAMPING_MAX_FACTOR * motors.back_emf_damping()
        self._per_volt = np.where(by_duty, position_stiffness(motors), 0.0)

    def motor_parameters(self) -> MotorParameters:
        """Electrical constants of every joint's servo that gains are made with."""
        return self._motors

    @property
    def voltage(self) -> float:
        """Supply that gains are scaled with now [V]."""
        return self._voltage

    def map(self, command: JointCommand, frame: SensorFrame) -> tuple[ServoGoals, AppliedCommand]:
        """Goals to write and what they amount to; both objects are reused by the next call."""
        self._follow_voltage(frame)
        if self._learned is not None:
            self._learn(self._learned, frame)
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
        if self._extra_damping is not None or self._host is not None:
            self._ahead.update(frame)
        if self._extra_damping is not None:
            lead -= self._extra_damping * self._ahead.velocity

        goal = position + (lead + torque) / self._divisor
        wanted = np.rint((goal + self._offset) * self._counts_per_radian)
        counts = np.minimum(np.maximum(wanted, -CENTRE_COUNTS), CENTRE_COUNTS - 1)
        sent = self._sent
        np.divide(counts, self._counts_per_radian, out=sent)
        sent -= self._offset
        np.subtract(applied.stiffness * (sent - position), lead, out=applied.torque)
        np.add(counts, CENTRE_COUNTS, out=self._goals.position, casting="unsafe")

        error = np.abs(sent - frame.joint_position)
        applied.limit[:] = self._gain_flags
        self._flag(Limit.SATURATION, error > self._saturation_error)
        self._flag(Limit.POSITION, (position != command.position) | (counts != wanted))
        self._flag(Limit.TORQUE, torque != command.torque)
        if self._host is not None and self._goals.current is not None:
            amount = self._host.realise(torque, self._ahead, applied, self._voltage)
            self._goals.current[self._host_joints] = amount
        return self._goals, applied

    def _learn(self, learned: LearnedMotors, frame: SensorFrame) -> None:
        """Goals act within the tick in which they are sent: this frame answers to the last ones."""
        if learned.take(frame, self._sent, self._p_gain, self._voltage):
            self._motors = replace(
                self._motors,
                torque_constant=learned.torque_constant.copy(),
                resistance=learned.resistance.copy(),
            )
            self._adopt_constants(self._motors, self._by_duty)
            self._gains_for = None

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
        per_count = self._per_volt * self._voltage + self._per_current
        wanted = np.rint(np.clip(command.stiffness / per_count, 0, P_GAIN_MAX))
        change = np.abs(wanted - self._p_gain) > P_GAIN_HYSTERESIS * self._p_gain
        np.copyto(self._p_gain, wanted, where=change)
        np.multiply(self._p_gain, per_count, out=applied.stiffness)
        np.maximum(applied.stiffness, per_count, out=self._divisor)
        if self._host is not None:
            host = self._host_joints
            applied.stiffness[host] = np.minimum(command.stiffness, self._most_stiffness)[host]
        self._goals.p_gain[:] = self._p_gain
        self._saturation_error = self._full_effort / np.maximum(self._p_gain, 1)

        own = self._own_damping
        np.clip(command.damping, own, self._most_damping, out=applied.damping)
        extra = applied.damping - own
        self._extra_damping = extra if extra.any() else None
        too_low = command.damping < (1 - DAMPING_TOLERANCE) * own
        damping_off = too_low | (command.damping > applied.damping)
        off = np.abs(applied.stiffness - command.stiffness)
        stiffness_off = off > 2 * P_GAIN_HYSTERESIS * command.stiffness
        self._gain_flags = damping_off.astype(np.int64) * int(Limit.DAMPING)
        self._gain_flags += stiffness_off.astype(np.int64) * int(Limit.STIFFNESS)


def current_limits(description: RobotDescription, motors: MotorParameters) -> Ints:
    """Largest Goal Current of every joint [counts], (n,); 0 for a servo without current.

    The servo's own limit, or less where the joint's torque limit is less.
    """
    limits = np.zeros(len(description.joints), dtype=np.int64)
    for index, joint in enumerate(description.joints):
        if joint.servo is None:
            continue
        model = find_servo_model(joint.servo)
        limits[index] = model.current_limit or 0
        if model.current_unit is not None:
            allowed = joint.torque_limit / float(motors.torque_constant[index])
            limits[index] = min(limits[index], int(allowed / model.current_unit))
    return limits
