"""The electrical fit: current against duty and movement gives motor constants and backlash."""

from dataclasses import dataclass

import numpy as np

from hil.identify_load import JointLoad
from hil.identify_record import Estimated, JointRecord, least_squares, running_integral
from hil.interface import Floats
from hil.servo import COUNTS_PER_RADIAN, PWM_FULL

LAGS = 4
"""Most ticks that a goal may take until a sample shows its effect."""
LEAST_LOAD = 0.01
"""Torque on the teeth above which it is sure which side they touch [N·m],"""
LEAST_LOAD_SHARE = 0.08
"""or this share of the torque that nine in ten samples stay below, if that is more."""
CLOSING = 4
"""Ticks that the teeth take to come to the other side."""
LEAST_SAMPLES = 50
"""On each side of the gap, to tell it at all."""
PIECE_S = 6.0
"""Length of record whose integrals have an origin of their own."""
COUNT = 1.0 / COUNTS_PER_RADIAN
"""[rad]"""


@dataclass(frozen=True, slots=True)
class MotorFit:
    """i = a·V·P·c·e/885 − b·ω_r: a = 1/(D·R), b = k/R."""

    a: Estimated
    b: Estimated
    gap: Estimated
    lag: int
    """Ticks until a sample shows the effect of a goal."""
    residual: float
    """[A·s]"""


def fit_motor(record: JointRecord, load: JointLoad) -> MotorFit:
    """The electrical fit with the lag that leaves least over."""
    side = _side(record, load)
    found = [_fit_motor_at(record, side, lag) for lag in range(1, LAGS + 1)]
    return min(found, key=lambda motor: motor.residual)


def _fit_motor_at(record: JointRecord, side: Floats, lag: int) -> MotorFit:
    """The electrical fit for goals that take `lag` ticks. Samples on an unsure side are left out.

    Every piece of the record has an origin of its own, so that the error of an integral does not
    run up, and a constant current is the sensor's zero.
    """
    period, ticks = record.period_s, record.position.size
    time = np.arange(ticks) * period
    pieces = (time / PIECE_S).astype(int)
    table = [running_integral(_drive(record, lag), period), -record.position, -0.5 * side, time]
    table += [(pieces == piece).astype(float) for piece in range(int(pieces[-1]) + 1)]
    columns, usable = np.column_stack(table), side != 0.0
    both = min(np.count_nonzero(side > 0), np.count_nonzero(side < 0)) >= LEAST_SAMPLES
    if not both:  # One side, or no load at all: the gap shows nowhere.
        usable = np.arange(ticks) >= LAGS
        columns[:, 2] = 0.0
    columns, current = columns[usable], running_integral(record.current, period)[usable]
    kept = np.abs(columns).sum(axis=0) > 0
    values, covariance, residual = least_squares(columns[:, kept], current)
    deviations = np.sqrt(np.diag(covariance))
    a, b = (Estimated(float(values[i]), float(deviations[i])) for i in (0, 1))
    gap = Estimated(0.0, float("inf"))
    if both:
        width = max(0.0, float(values[2]) / b.value)
        gap = Estimated(width, float(np.hypot(deviations[2] / b.value, 0.5 * COUNT)))
    return MotorFit(a, b, gap, lag, residual)


def _drive(record: JointRecord, lag: int) -> Floats:
    """V·P·c·e/885 at every sample [V], for a goal `lag` ticks old: D times the voltage."""
    gain = np.roll(record.p_gain, lag) * COUNTS_PER_RADIAN / PWM_FULL
    drive: Floats = record.voltage * gain * (np.roll(record.goal, lag) - record.position)
    return drive


def _side(record: JointRecord, load: JointLoad) -> Floats:
    """Side of the gap on which the teeth surely touch: +1 or -1, 0 where it is not sure."""
    smooth = np.convolve(record.velocity, np.ones(3) / 3, mode="same")
    torque = load.inertia(record.position) * np.gradient(smooth, record.period_s)
    torque += load.gravity(record.position)
    least = max(LEAST_LOAD, LEAST_LOAD_SHARE * float(np.quantile(np.abs(torque), 0.9)))
    side = np.where(np.abs(torque) > least, np.sign(torque), 0.0)
    settled = np.ones(side.size, dtype=np.bool_)
    for ago in range(1, CLOSING + 1):
        settled &= np.roll(side, ago) == side
    settled[: LAGS + CLOSING] = False
    return np.where(settled, side, 0.0)


def goal_drive(record: JointRecord, lag: int) -> Floats:
    """V·P·c·goal/885 [V]: what only the goal contributes to the drive."""
    gain = np.roll(record.p_gain, lag) * COUNTS_PER_RADIAN / PWM_FULL
    drive: Floats = record.voltage * gain * np.roll(record.goal, lag)
    return drive


def rotor_speed(record: JointRecord, motor: MotorFit) -> Floats:
    """Speed of the rotor behind the teeth [rad/s]."""
    speed: Floats = (motor.a.value * _drive(record, motor.lag) - record.current) / motor.b.value
    return speed
