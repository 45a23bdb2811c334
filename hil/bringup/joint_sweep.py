"""How far joints go, swept by hand from end to end."""

from collections.abc import Mapping

import numpy as np

from hil.bringup.calibrating import Calibrating
from hil.bringup.deed import Deed
from hil.bringup.joint_signs import Angles, middle_pose

CABLES = (
    "Move every joint slowly from end to end, one after another, as far as cables and parts allow "
    "and no farther; Enter when all are through"
)
STOPS = (
    "Push every joint gently against its stop at one end and at the other, one after another; "
    "Enter when all are through"
)
NARROWER = np.radians(2.0)
"""A swept range that is narrower than the robot file's by more is told."""
_LEAST = np.radians(10.0)
"""A joint that went less was forgotten."""

Ranges = dict[str, tuple[float, float]]
"""Least and largest angle [rad], by joint."""


def travel(ends: tuple[float, float]) -> float:
    """From end to end [rad]."""
    return ends[1] - ends[0]


def sweep(work: Calibrating, text: str, joints: list[str], zeros: Angles | None) -> Ranges:
    """Ranges of all joints, until Enter, or until all went as far as the robot file says.

    Angles are less `zeros`; without them they are raw, and only Enter ends it.
    """
    watch = _Watch(work, joints, zeros)
    while True:
        work.wait(text, *_ends(work, joints), look=watch.look)
        short = [one for one in joints if travel(watch.seen.get(one, (0.0, 0.0))) < _LEAST]
        if not short:
            return {joint: watch.seen[joint] for joint in joints}
        text = f"{', '.join(short)}: hardly moved. Move from end to end"


class _Watch:
    """Keeps how far joints went."""

    def __init__(self, work: Calibrating, joints: list[str], zeros: Angles | None) -> None:
        self._work, self._zeros = work, zeros or {}
        self._ranges = {one.name: one.range for one in work.description.joints}
        self._joints = joints
        self._left = list(joints) if zeros is not None else []
        self._ends_alone = zeros is not None
        self.seen: Ranges = {}

    def look(self) -> bool:
        """Whether all were seen to go their whole range."""
        for joint, raw in self._work.sampler.angles().items():
            if joint in self._joints:
                angle = raw - self._zeros.get(joint, 0.0)
                low, high = self.seen.get(joint, (angle, angle))
                self.seen[joint] = min(low, angle), max(high, angle)
        for joint in [one for one in self._left if _is_whole(self.seen, self._ranges, one)]:
            self._left.remove(joint)
            self._work.dialogue.say(f"  {joint}: whole range")
        return self._ends_alone and not self._left


def _is_whole(seen: Ranges, ranges: Mapping[str, tuple[float, float]], joint: str) -> bool:
    if joint not in seen:
        return False
    (low, high), own = seen[joint], ranges[joint]
    slack = 0.5 * float(NARROWER)
    return low < own[0] + slack and high > own[1] - slack


def _ends(work: Calibrating, joints: list[str]) -> tuple[Deed, ...]:
    """To both ends and back; a virtual hand moves all joints at once."""
    pose = middle_pose(work)
    ranges = {one.name: one.range for one in work.description.joints if one.name in joints}
    return (
        Deed(lifted=True, joints=pose),
        Deed(joints={joint: ends[0] for joint, ends in ranges.items()}),
        Deed(joints={joint: ends[1] for joint, ends in ranges.items()}),
        Deed(joints=pose),
    )
