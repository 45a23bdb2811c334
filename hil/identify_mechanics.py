"""The mechanical fit: momentum gives rotor inertia, friction, delay, and which divisor it is."""

import numpy as np

from hil.identify_load import JointLoad
from hil.identify_motor import LAGS, MotorFit, goal_drive, rotor_speed
from hil.identify_record import Estimated, JointRecord, least_squares, running_integral
from hil.interface import Bools, Floats, Ints

WINDOW = 4
"""Ticks over which momentum is balanced."""
LEAST_SPEED = 0.06
"""Below it the sign of friction is uncertain [rad/s]."""
BLOCKS = 8
"""Parts of the record that are left out in turn."""
LEAST_LINK_SHARE = 0.2
"""Of what the motor does, done to the links and not to rotor and friction, for the load to tell
the divisor."""


def fit_mechanics(
    record: JointRecord, load: JointLoad, motor: MotorFit, k: float
) -> tuple[Floats, Floats, float]:
    """Armature, friction, viscous friction and T/2 − d; their deviations; residual torque."""
    links, current, columns = _balance(record, load, motor)
    columns, right = columns * (1.0, 1.0, 1.0, -k), k * current - links
    values, covariance, residual = least_squares(columns, right)
    deviations = np.maximum(np.sqrt(np.diag(covariance)), _jackknife(columns, right))
    return values, deviations, residual / (WINDOW * record.period_s)


def fit_divisor(
    record: JointRecord, load: JointLoad, motor: MotorFit, resistance: float
) -> Estimated:
    """The divisor that makes the motor carry the links: D = b/(a·k̂), k̂ from the momentum.

    Unknown where the links are too light to tell: friction and the rotor then take all there is.
    """
    links, current, columns = _balance(record, load, motor)
    table = np.column_stack((current, -columns[:, :3], columns[:, 3]))
    values, covariance, _ = least_squares(table, links)
    k, deviation = float(values[0]), float(np.sqrt(covariance[0, 0]))
    share = float(np.sqrt(np.mean(links**2) / np.mean((motor.b.value * resistance * current) ** 2)))
    if k <= 0 or share < LEAST_LINK_SHARE:
        return Estimated(float("nan"), float("inf"))
    divisor = motor.b.value / (motor.a.value * k)
    return Estimated(divisor, divisor * deviation / k)


def _windows(record: JointRecord, motor: MotorFit) -> tuple[Ints, Bools]:
    """First ticks of windows, and which of them move in one direction throughout."""
    starts = np.arange(LAGS, record.position.size - WINDOW, WINDOW)
    rotor = rotor_speed(record, motor)
    inside = rotor[starts[:, None] + np.arange(WINDOW + 1)]
    moving = (np.abs(inside) > LEAST_SPEED).all(axis=1)
    same = (inside > 0).all(axis=1) | (inside < 0).all(axis=1)
    return starts, moving & same


def _integral(values: Floats, starts: Ints, period_s: float) -> Floats:
    """Trapezoidal integral over each window."""
    running = running_integral(values, period_s)
    part: Floats = running[starts + WINDOW] - running[starts]
    return part


def _balance(
    record: JointRecord, load: JointLoad, motor: MotorFit
) -> tuple[Floats, Floats, Floats]:
    """Terms of the momentum balance over the usable windows.

    The links' momentum and gravity (m,); ∫i (m,); and the columns Δω_r, ∫sgn ω_r, ∫ω_r and the
    sum of the goals' current jumps (m, 4).
    """
    starts, usable = _windows(record, motor)
    starts = starts[usable]
    period, position = record.period_s, record.position
    rotor = rotor_speed(record, motor)
    inertia = load.inertia(position[starts])
    links = inertia * (record.velocity[starts + WINDOW] - record.velocity[starts])
    links += _integral(load.gravity(position), starts, period)
    jump = motor.a.value * (goal_drive(record, motor.lag - 1) - goal_drive(record, motor.lag))
    jumps = np.concatenate(([0.0], np.cumsum(jump)))
    columns = np.column_stack(
        (
            rotor[starts + WINDOW] - rotor[starts],
            _integral(np.sign(rotor), starts, period),
            _integral(rotor, starts, period),
            jumps[starts + WINDOW] - jumps[starts],
        )
    )
    return links, _integral(record.current, starts, period), columns


def _jackknife(table: Floats, right: Floats) -> Floats:
    """Deviations from leaving out one block of rows after the other.

    Sweep, steps and chirp do not agree where the model is wrong (other joints give way, friction
    is not constant), which residuals alone do not show.
    """
    block = np.arange(right.size) * BLOCKS // right.size
    found = np.array(
        [least_squares(table[block != b], right[block != b])[0] for b in range(BLOCKS)]
    )
    spread = np.square(found - found.mean(axis=0)).sum(axis=0)
    deviations: Floats = np.sqrt(spread * (BLOCKS - 1) / BLOCKS)
    return deviations
