"""What a recording says of joint zeros: a sole that stands flat must be seen as flat."""

from dataclasses import dataclass

import numpy as np

from hil.after.fitting import BLOCKS
from hil.after.load_model import LoadModel
from hil.after.recorded import RecordedRun
from hil.interface import Bools, Floats

CORNER_SHARE = 0.03
"""Of the weight, on three corners: the sole lies on the floor,"""
STANCE_SHARE = 0.6
"""and of the weight on the whole foot: it carries."""
LEAST_TICKS = 60
"""Fewer ticks with a flat sole say nothing."""


@dataclass(frozen=True, slots=True)
class SoleSigns:
    """How both soles seem to lean while they lie flat on the floor."""

    lean: Floats
    """Mean pitch and roll [rad], (2, 2): foot, axis; NaN where a foot never stood."""
    deviation: Floats
    """(2, 2)"""
    flat: Bools
    """Ticks in which a foot carries on a flat sole, (T, 2)."""


def sole_signs(run: RecordedRun, model: LoadModel) -> SoleSigns:
    """Orientation of the IMU and joint angles through the kinematics of the legs.

    A joint zero of δ turns the sole of its leg by δ about the joint's axis, whatever the pose, and
    the other one not at all; an IMU that leans turns both.
    """
    frame = run.steady["frame"]
    weight = float(run.meta["weight_n"])
    corners = frame["foot_force"]
    flat = np.count_nonzero(corners > CORNER_SHARE * weight, axis=2) >= 3
    share = np.full(flat.shape[1], STANCE_SHARE)
    if not run.steady["status"]["walking"].any():  # A robot that stands has its weight on both.
        share[:] = 0.5 * STANCE_SHARE
    flat &= corners.sum(axis=2) > share * weight
    leant = model.sole_axes(frame["imu_orientation"], frame["joint_position"])
    lean, deviation = np.full((2, 2, 2), np.nan)
    for foot in (0, 1):
        samples = leant[flat[:, foot], foot]
        if len(samples) >= LEAST_TICKS:
            parts = np.array([part.mean(axis=0) for part in np.array_split(samples, BLOCKS)])
            lean[foot] = samples.mean(axis=0)
            deviation[foot] = parts.std(axis=0, ddof=1) / np.sqrt(BLOCKS)
    return SoleSigns(lean, deviation, flat)
