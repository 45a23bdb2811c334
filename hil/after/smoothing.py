"""Values and derivatives of sampled signals, from parabolas through neighbouring samples."""

import numpy as np

from hil.interface import Floats

HALF_S = 0.0134
"""Samples so far to each side count [s]: four ticks at 300 Hz."""


def half_width(rate_hz: int) -> int:
    """Samples to each side of a parabola."""
    return max(2, round(HALF_S * rate_hz))


def parabolas(values: Floats, rate_hz: int) -> tuple[Floats, Floats, Floats]:
    """Value, first and second derivative at every sample, along the first axis.

    Least squares of a + b·t + c·t² over the samples around each one, without delay (Savitzky and
    Golay, Analytical Chemistry 36 (1964) 1627). Beyond its ends the signal goes on as its mirror
    image through the last sample, so that it neither jumps nor bends there.
    """
    half = half_width(rate_hz)
    times = np.arange(-half, half + 1) / rate_hz
    weights = np.linalg.pinv(np.vander(times, 3, increasing=True))
    around = [(half, half)] + [(0, 0)] * (values.ndim - 1)
    padded = np.pad(values, around, mode="reflect", reflect_type="odd")
    windows = np.lib.stride_tricks.sliding_window_view(padded, times.size, axis=0)
    value, slope, bend = (windows @ row for row in weights)
    return value, slope, 2.0 * bend


def smooth(values: Floats, rate_hz: int) -> Floats:
    """The values of `parabolas` alone."""
    return parabolas(values, rate_hz)[0]
