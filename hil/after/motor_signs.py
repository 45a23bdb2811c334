"""What a recording says of every servo's motor: delay of its goals, drive, torque constant."""

from dataclasses import dataclass

import numpy as np

from hil.after.fitting import BLOCKS, fit
from hil.after.recorded import RecordedRun
from hil.interface import Floats
from hil.servo import COUNTS_PER_RADIAN, PWM_FULL, MotorParameters

LAGS = 7
"""Delays that are tried, from 0 ticks on."""
MEAN_S = 0.05
"""Samples are averaged over so long first [s]: a rotor that rattles in its backlash turns, on the
mean, as the joint does."""
LEAST_DRIVE = 0.3
"""Standard deviation of means below which a motor's drive says nothing [V],"""
LEAST_JUMP = 0.03
"""and of what the goals add to it from tick to tick, for the delay [V]."""
LEAST_SPEED = 0.6
"""Slower means say nothing of back-EMF [rad/s]; with fewer than"""
LEAST_MEANS = 40
"""faster ones, the torque constant stays unknown."""


@dataclass(frozen=True, slots=True)
class MotorSigns:
    """Found values and their standard deviations, shape (n,) each; NaN and inf: unknown."""

    delay: tuple[Floats, Floats]
    """From the tick whose goal it is until a sample shows its current [s]."""
    drive: tuple[Floats, Floats]
    """Current for a position error, over that of the driver's constants."""
    torque_constant: tuple[Floats, Floats]
    """Over the driver's."""


def motor_signs(run: RecordedRun, motors: MotorParameters) -> MotorSigns:
    """Signs of every joint; `motors` are the constants that measured torques were made with.

    The servo puts the duty P·e/(885·D) of the supply V on its motor, e being the error in counts,

        i = a·V·P·c·(goal − q)/(885·D) − b·q̇,    a = 1/R,  b = k/R,

    with the goal of d ticks ago. Whatever hangs on the joint is in q and q̇, which are measured: no
    model of the body enters. d is where the parabola through the residual variances of three
    neighbouring lags is lowest; a and b are then sought in means of 50 ms. Errors in the voltage
    (a goal that came within the tick, a rattling rotor) make a look too small, and the voltage by
    the current too large: the drive is the geometric mean of both, unsure by its distance to a.
    """
    n = len(run.joints)
    found = np.array([_joint(run, motors, joint) for joint in range(n)])
    delay, drive, constant = (
        (np.ascontiguousarray(found[:, i]), np.ascontiguousarray(found[:, i + 1]))
        for i in (0, 2, 4)
    )
    return MotorSigns(delay, drive, constant)


def _joint(run: RecordedRun, motors: MotorParameters, joint: int) -> tuple[float, ...]:
    rows = run.steady
    frame, applied = rows["frame"], rows["applied"]
    current = frame["joint_torque"][:, joint] / motors.torque_constant[joint]
    position, speed = frame["joint_position"][:, joint], frame["joint_velocity"][:, joint]
    goal, p_gain = applied["goal"][:, joint], applied["p_gain"][:, joint]
    scale = COUNTS_PER_RADIAN / (PWM_FULL * motors.gain_divisor[joint])
    kept = slice(LAGS - 1, goal.size)
    volts = np.array(
        [
            run.supply[kept]
            * np.clip(
                scale * np.roll(p_gain, lag)[kept] * (np.roll(goal, lag) - position)[kept], -1, 1
            )
            for lag in range(LAGS)
        ]
    )
    current, speed = current[kept], speed[kept]
    delay, delay_deviation = _delay(volts, speed, current)
    if np.std(volts[1] - volts[0]) < LEAST_JUMP:
        delay, delay_deviation = float("nan"), float("inf")
    low = 1 if np.isnan(delay) else min(int(delay), LAGS - 2)
    driven = volts[low] + (np.nan_to_num(delay, nan=1.0) - low) * (volts[low + 1] - volts[low])
    a, b = _constants(driven, speed, current, run.rate_hz, motors, joint)
    loss = _correlation(driven, speed, current, run.rate_hz)
    resistance, constant = motors.resistance[joint], motors.torque_constant[joint]
    share = float(np.hypot(a[1] / a[0], b[1] / b[0])) if b[0] else float("inf")
    known = np.isfinite(share)
    return (
        delay / run.rate_hz,
        delay_deviation / run.rate_hz,
        a[0] / loss * resistance,
        float(np.hypot(a[1], a[0] / loss - a[0])) * resistance,
        b[0] / a[0] / constant if known else float("nan"),
        share * b[0] / a[0] / constant if known else float("inf"),
    )


def _delay(volts: Floats, speed: Floats, current: Floats) -> tuple[float, float]:
    """Delay and its deviation in ticks, over the whole record and from its parts."""
    variances = np.array([_residuals(row, speed, current) ** 2 for row in volts])
    parts = np.array_split(variances, BLOCKS, axis=1)
    ticks = [_lowest(part.mean(axis=1)) for part in parts]
    return _lowest(variances.mean(axis=1)), float(np.std(ticks, ddof=1) / np.sqrt(BLOCKS))


def _residuals(volts: Floats, speed: Floats, current: Floats) -> Floats:
    table = np.column_stack((volts, speed, np.ones(volts.size)))
    values, *_ = np.linalg.lstsq(table, current, rcond=None)
    residuals: Floats = current - table @ values
    return residuals


def _lowest(variances: Floats) -> float:
    """Where the parabola through the lowest of some values and its neighbours is lowest."""
    middle = int(np.clip(np.argmin(variances), 1, variances.size - 2))
    before, here, after = variances[middle - 1 : middle + 2].tolist()
    bend = before + after - 2 * here
    return float(middle) if bend <= 0 else middle + float(np.clip(0.5 * (before - after) / bend,
                                                                  -1, 1))  # fmt: skip


def _constants(
    volts: Floats,
    speed: Floats,
    current: Floats,
    rate_hz: int,
    motors: MotorParameters,
    joint: int,
) -> tuple[tuple[float, float], tuple[float, float]]:
    """a and b with their deviations; b of a joint that never moves fast is (0, inf)."""
    volts, speed, current = _means(rate_hz, volts, speed, current)
    one = np.ones(volts.size)
    if np.std(volts) < LEAST_DRIVE:
        return (float("nan"), float("inf")), (0.0, float("inf"))
    if np.count_nonzero(np.abs(speed) > LEAST_SPEED) >= LEAST_MEANS:
        values, deviations = fit(np.column_stack((volts, -speed, one)), current)
        return (float(values[0]), float(deviations[0])), (float(values[1]), float(deviations[1]))
    known = motors.torque_constant[joint] / motors.resistance[joint] * speed
    values, deviations = fit(np.column_stack((volts, one)), current + known)
    return (float(values[0]), float(deviations[0])), (0.0, float("inf"))


def _correlation(volts: Floats, speed: Floats, current: Floats, rate_hz: int) -> float:
    """Of voltage and current, with what the speed explains taken off both; at least 0.1."""
    volts, speed, current = _means(rate_hz, volts, speed, current)
    table = np.column_stack((speed, np.ones(speed.size)))
    left = []
    for values in (volts, current):
        explained, *_ = np.linalg.lstsq(table, values, rcond=None)
        left.append(values - table @ explained)
    power = float(np.sqrt((left[0] @ left[0]) * (left[1] @ left[1])))
    return max(0.1, float(left[0] @ left[1]) / power) if power > 0.0 else 1.0


def _means(rate_hz: int, *signals: Floats) -> list[Floats]:
    """Means of 50 ms, without the rest at the end."""
    size = max(1, round(MEAN_S * rate_hz))
    count = signals[0].size // size
    return [values[: count * size].reshape(count, size).mean(axis=1) for values in signals]
