"""The record of one moved joint, and the arithmetic that its fits share."""

from dataclasses import dataclass

import numpy as np

from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class JointRecord:
    """Samples of one joint in joint direction, at every tick; goals are those sent after it."""

    period_s: float
    position: Floats
    """[rad], shape (ticks,)."""
    velocity: Floats
    """[rad/s]"""
    current: Floats
    """[A]"""
    voltage: Floats
    """Supply [V]."""
    goal: Floats
    """[rad], quantised as sent."""
    p_gain: Floats
    """Position P Gain, register value."""


@dataclass(frozen=True, slots=True)
class Estimated:
    """A value and its standard deviation."""

    value: float
    deviation: float

    @property
    def share(self) -> float:
        """Deviation as a share of the value."""
        return self.deviation / abs(self.value)


def running_integral(values: Floats, period_s: float) -> Floats:
    """Trapezoidal integral from the first sample to every one."""
    steps = 0.5 * period_s * (values[1:] + values[:-1])
    return np.concatenate(([0.0], np.cumsum(steps)))


def least_squares(table: Floats, right: Floats) -> tuple[Floats, Floats, float]:
    """Solution, its covariance and the root mean square residual.

    Neighbouring residuals are alike (friction, quantisation), so that there are fewer independent
    ones than samples: the covariance is that of white noise times (1 + ρ)/(1 − ρ), with ρ the
    correlation of neighbours.
    """
    scale = np.sqrt(np.square(table).sum(axis=0))
    scale[scale == 0.0] = 1.0
    scaled = table / scale
    values, *_ = np.linalg.lstsq(scaled, right, rcond=None)
    residual = right - scaled @ values
    count = max(1, right.size - table.shape[1])
    variance = float(residual @ residual) / count
    power = float(residual @ residual) or 1.0
    alike = min(0.98, max(0.0, float(residual[1:] @ residual[:-1]) / power))
    inverse = np.linalg.pinv(scaled.T @ scaled)
    covariance = variance * (1 + alike) / (1 - alike) * inverse / np.outer(scale, scale)
    return values / scale, covariance, float(np.sqrt(variance))
