"""Joints and boards that are no longer heard of."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import NEVER_NS, Bools, Ints, SensorFrame
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

MAX_MISSED_TICKS = 5
"""A joint not heard of in more ticks than this in a row has lost its servo (17 ms at 300 Hz;
libfranka stops at 20 ms). Ticks are counted, not time: a pause of the program is no silence."""
LINK_TICKS = 100
"""Ticks over which the share of answers is counted (libfranka counts 100 commands)."""
LOST_WARN, LOST_STOP = 5, 10
"""Answers lost of LINK_TICKS above which a joint's link is reported, and stops the robot
(libfranka's figures for a link that is poor, and insufficient: 0.95 and 0.90)."""
MAX_BOARD_AGE_NS = 50_000_000
"""A foot board or IMU that is silent for longer counts as lost."""


class SilenceMonitor:
    """Ticks missed in a row, and share of answers over the last LINK_TICKS, joint by joint."""

    def __init__(self, description: RobotDescription) -> None:
        n = len(description.joints)
        self._names = description.joint_names
        self._missed: Ints = np.zeros(n, dtype=np.int64)
        self._answered: Bools = np.ones((LINK_TICKS, n), dtype=np.bool_)
        self._lost: Ints = np.zeros(n, dtype=np.int64)
        self._row = 0
        self._clean = True
        """Nothing was lost in the window: it is all the same where in it the next tick stands."""

    def look(self, situation: Situation) -> list[Event]:
        """Joints that are silent, or whose link is poor."""
        valid, row = situation.frame.joint_valid, self._answered[self._row]
        if self._clean and np.count_nonzero(valid) == valid.size:
            return []
        self._lost += row
        self._lost -= valid
        row[:] = valid
        self._row = (self._row + 1) % LINK_TICKS
        self._missed += 1
        self._missed[valid] = 0
        self._clean = not self._lost.any()
        return self._events()

    def _events(self) -> list[Event]:
        events = []
        for name, missed, lost in zip(
            self._names, self._missed.tolist(), self._lost.tolist(), strict=True
        ):
            if missed > MAX_MISSED_TICKS:
                events.append(Event(name, "silent", Severity.SOFT_STOP))
            elif lost > LOST_STOP:
                events.append(Event(name, "link lost too often", Severity.SOFT_STOP))
            elif lost > LOST_WARN:
                events.append(Event(name, "poor link", Severity.WARN))
        return events


class BoardMonitor:
    """Age of the IMU's and of the foot boards' last sample."""

    def __init__(self, description: RobotDescription) -> None:
        self._imu = None if description.imu is None else description.imu.board
        self._feet = tuple(description.feet[side].board for side in ("left", "right"))

    def look(self, situation: Situation) -> list[Event]:
        """Boards that are silent."""
        frame, silent = situation.frame, []
        if self._imu is not None and frame.imu_age_ns > MAX_BOARD_AGE_NS:
            silent.append(self._imu)
        for board, age_ns in zip(self._feet, frame.foot_age_ns.tolist(), strict=True):
            if board is not None and age_ns > MAX_BOARD_AGE_NS:
                silent.append(board)
        return [Event(board, "silent", Severity.SOFT_STOP) for board in silent]


def never_heard(description: RobotDescription, frame: SensorFrame) -> list[str]:
    """Joints and boards that have not delivered anything yet."""
    silent = [
        name
        for name, age_ns in zip(description.joint_names, frame.joint_age_ns, strict=True)
        if age_ns == NEVER_NS
    ]
    if frame.imu_present and frame.imu_age_ns == NEVER_NS:
        silent.append("imu")
    for side, age_ns in zip(("left", "right"), frame.foot_age_ns, strict=True):
        board = description.feet[side].board  # type: ignore[index]
        if board is not None and age_ns == NEVER_NS:
            silent.append(board)
    return silent
