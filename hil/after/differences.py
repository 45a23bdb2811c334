"""How far two runs are apart, joint by joint: tick by tick for a twin, else stride by stride."""

from dataclasses import dataclass

import numpy as np

from hil.after.recorded import RecordedRun
from hil.interface import Floats, Ints
from hil.recording import Rows

BINS = 100
"""Points of a resampled stride: half for the left foot's stance, half for the right one's."""
LEAST_STRIDES = 3


@dataclass(frozen=True, slots=True)
class JointCurves:
    """Two runs laid over each other; arrays have the shape (P, n)."""

    aligned: str
    """How: `tick`, `phase` or `mean`."""
    axis: Floats
    """Time [s] or place in the stride, (P,)."""
    position: tuple[Floats, Floats]
    """[rad]"""
    torque: tuple[Floats, Floats]
    """[N·m]"""
    strides: tuple[int, int]
    """That a phase's points are the mean of; 0 where there is no phase."""

    def rms(self) -> tuple[Floats, Floats]:
        """Root mean square differences in position [rad] and torque [N·m], (n,) each."""
        position, torque = (
            np.sqrt(np.mean((pair[1] - pair[0]) ** 2, axis=0))
            for pair in (self.position, self.torque)
        )
        return position, torque


def joint_curves(first: RecordedRun, second: RecordedRun) -> JointCurves:
    """Lay two runs over each other.

    A twin has the ticks of its run. Walks are cut into strides where the left foot takes over;
    both halves of every stride are resampled on phase, and strides are averaged. Runs without
    strides are compared by their means alone.
    """
    if _twins(first, second):
        return _by_tick(first, second)
    cuts = [_strides(run.steady) for run in (first, second)]
    if min(len(cut) for cut in cuts) > LEAST_STRIDES:
        axis = (np.arange(BINS) + 0.5) / BINS
        curves = [
            [_mean_stride(run.steady["frame"][name], run.steady["status"]["stance"], cut)
             for run, cut in zip((first, second), cuts, strict=True)]
            for name in ("joint_position", "joint_torque")
        ]  # fmt: skip
        position, torque = ((pair[0], pair[1]) for pair in curves)
        return JointCurves("phase", axis, position, torque, (len(cuts[0]) - 1, len(cuts[1]) - 1))
    means = [
        [run.steady["frame"][name].mean(axis=0, keepdims=True) for run in (first, second)]
        for name in ("joint_position", "joint_torque")
    ]
    position, torque = ((pair[0], pair[1]) for pair in means)
    return JointCurves("mean", np.zeros(1), position, torque, (0, 0))


def _twins(first: RecordedRun, second: RecordedRun) -> bool:
    for one, other in ((first, second), (second, first)):
        origin = one.meta.get("twin_of")
        if origin is not None and origin["started"] == other.meta["started"]:
            return True
    return False


def _by_tick(first: RecordedRun, second: RecordedRun) -> JointCurves:
    one, other = (run.steady["timing"]["tick"] for run in (first, second))
    _, *places = np.intersect1d(one, other, assume_unique=True, return_indices=True)
    rows = [run.steady[place] for run, place in zip((first, second), places, strict=True)]
    position, torque = (
        (rows[0]["frame"][name], rows[1]["frame"][name])
        for name in ("joint_position", "joint_torque")
    )
    return JointCurves("tick", np.asarray(rows[0]["time_s"]), position, torque, (0, 0))


def _strides(rows: Rows) -> Ints:
    """Ticks at which the left foot takes over from the right one."""
    status = rows["status"]
    taken = (status["stance"][1:] == 0) & (status["stance"][:-1] == 1)
    return np.flatnonzero(taken & status["walking"][1:]) + 1


def _mean_stride(values: Floats, stance: Ints, cuts: Ints) -> Floats:
    """Mean over the strides between cuts, each half resampled on its own, (BINS, n)."""
    half = (np.arange(BINS // 2) + 0.5) / (BINS // 2)
    total = np.zeros((BINS, values.shape[1]))
    for begin, end in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
        middle = begin + int(np.argmax(stance[begin:end] == 1))
        places = np.concatenate((begin + half * (middle - begin), middle + half * (end - middle)))
        low = np.minimum(places.astype(int), len(values) - 2)
        share = (places - low)[:, None]
        total += values[low] * (1.0 - share) + values[low + 1] * share
    return total / (len(cuts) - 1)
