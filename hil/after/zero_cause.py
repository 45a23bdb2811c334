"""Joint zeros from two runs' soles: which leg, and which of its joints."""

from dataclasses import dataclass

import numpy as np

from hil.after.signs import Signs
from hil.interface import Floats

AXES = ("pitch", "roll")
PARALLEL = 0.7
"""A joint turns a sole about an axis that it is so far along."""
SAMPLES = 200
"""Ticks at which torques of a supposed zero are computed."""
LEAST_GAP = 0.07
"""A joint that explains the torques worse than the best one by so much is none of them [N·m]; two
walks of a robot with friction and backlash on an uneven floor differ by less."""


@dataclass(frozen=True, slots=True)
class LegZero:
    """A sole that leans while it lies flat."""

    foot: int
    axis: int
    lean: float
    """More than in the first run [rad]."""
    deviation: float
    """[rad]"""
    joints: tuple[int, ...]
    """Joints whose zero may be wrong by it, the likeliest first."""
    excluded: tuple[int, ...]
    """Joints that turn the sole too, but that the torques speak against."""
    sign: int
    """+1 where the likeliest joint shows too much if the lean is positive."""


def sole_leans(first: Signs, second: Signs) -> tuple[Floats, Floats, Floats]:
    """IMU (2,), soles (2, 2) and deviations (2, 2), second minus first [rad]; NaN: unknown.

    What both soles lean by is the IMU's: of 0, left and right, the one in the middle. A twin's
    soles stand on nothing; a level floor stands for them.
    """
    known = [
        np.zeros((2, 2)) if signs.run.is_twin else signs.soles.lean for signs in (first, second)
    ]
    lean = known[1] - known[0]
    deviation = np.sqrt(
        sum(
            np.zeros((2, 2)) if signs.run.is_twin else signs.soles.deviation**2
            for signs in (first, second)
        )
    )
    imu = np.median(np.vstack((np.zeros(2), lean)), axis=0)
    return imu, lean - imu, deviation


def leg_zero(
    first: Signs, second: Signs, foot: int, axis: int, lean: float, deviation: float
) -> LegZero:
    """The joints that a leaning sole may come from, the likeliest first.

    The lean alone cannot tell hip, knee and ankle: every one of them turns the sole. But a zero
    also displaces the robot over its foot, the more the lower the joint is, and the joints above
    must carry that. Supposed zeros are compared by the torques of this leg that they leave
    unexplained, against those of the other leg and of the first run.
    """
    legs = _groups(second, axis)
    mine, other = legs[foot], legs[1 - foot]
    turning = np.sign(second.model.turning_axes()[:, 1 - axis])
    if not mine:
        return LegZero(foot, axis, lean, deviation, (), (), 1)
    change = _stance_excess(second, foot, mine) - _stance_excess(first, foot, mine)
    if len(other) == len(mine):
        change -= _stance_excess(second, 1 - foot, other) - _stance_excess(first, 1 - foot, other)
    left = []
    for joint in mine:
        explained = _torque_change(second, foot, joint, -lean * turning[joint])[mine]
        left.append(float(np.sqrt(np.sum((change - explained) ** 2))))
    order = np.argsort(left, kind="stable").tolist()
    ranked = [(mine[place], left[place] - left[order[0]] < LEAST_GAP) for place in order]
    joints = tuple(joint for joint, possible in ranked if possible)
    excluded = tuple(joint for joint, possible in ranked if not possible)
    return LegZero(foot, axis, lean, deviation, joints, excluded, int(turning[joints[0]]))


def _groups(signs: Signs, axis: int) -> tuple[list[int], list[int]]:
    """Joints of the left and of the right leg that turn about y (axis 0) or x (axis 1)."""
    along = np.abs(signs.model.turning_axes()[:, 1 - axis]) > PARALLEL
    names = signs.run.joints
    left, right = (
        [j for j, name in enumerate(names) if along[j] and name.startswith(f"{side}_")]
        for side in ("left", "right")
    )
    return left, right


def _stance_excess(signs: Signs, foot: int, joints: list[int]) -> Floats:
    """Mean torque that neither model nor friction nor rotor explain while a foot carries."""
    flat = signs.soles.flat[:, foot]
    if not flat.any():
        return np.zeros(len(joints))
    mean: Floats = signs.mechanics.excess[flat][:, joints].mean(axis=0)
    return mean


def _torque_change(signs: Signs, foot: int, joint: int, angle: float) -> Floats:
    """Mean change of the needed torques if a joint were turned by an angle in stance, (n,)."""
    places = np.flatnonzero(signs.soles.flat[:, foot])
    places = places[:: max(1, places.size // SAMPLES)]
    part = signs.mechanics.motion.at(places)
    angles, speeds, accelerations = (table[places] for table in signs.mechanics.table)
    turned = angles.copy()
    turned[:, joint] += angle
    before = signs.model.torques(part, angles, speeds, accelerations)
    after = signs.model.torques(part, turned, speeds, accelerations)
    change: Floats = (after - before).mean(axis=0)
    return change
