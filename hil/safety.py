"""When a run must stop: the body fell, or what is measured no longer arrives."""

import math
from dataclasses import dataclass

import numpy as np

from hil.description import RobotDescription
from hil.interface import NEVER_NS, Estimate, Ints, SensorFrame, Truth

MAX_TILT_RAD = 1.0
"""Tilt of the root body beyond which it counts as fallen."""
MIN_HEIGHT_SHARE = 0.6
"""Share of the starting height of the root body below which it counts as fallen."""
MAX_MISSED_TICKS = 5
"""A joint not heard of in more ticks than this in a row has lost its servo (17 ms at 300 Hz;
libfranka stops at 20 ms). Ticks are counted, not time: a pause of the program is no silence."""
MAX_BOARD_AGE_NS = 50_000_000
"""A foot board or IMU that is silent for longer counts as lost."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that went wrong, as `report.json` lists it."""

    time_s: float
    source: str
    name: str
    reaction: str


class Supervisor:
    """Judges every tick. The first fault it finds ends the run: soft stop, then torque off."""

    def __init__(self, description: RobotDescription) -> None:
        self._names = description.joint_names
        self._boards = tuple(description.feet[side].board for side in ("left", "right"))
        self._min_up = math.cos(MAX_TILT_RAD)
        self._missed: Ints = np.zeros(len(self._names), dtype=np.int64)
        self._min_height = -math.inf

    def begin_walking(self, base_height: float) -> None:
        """From now on a low root body counts as a fall; its height at T = 0 [m]."""
        self._min_height = MIN_HEIGHT_SHARE * base_height

    def judge(self, time_s: float, frame: SensorFrame, motion: Truth | Estimate) -> Fault | None:
        """The fault that ends the run, or none. `motion` is the truth where it is known."""
        if self.fallen(motion):
            return Fault(time_s, "body", "fell", "torque_off")
        lost = self._lost(frame)
        if lost is not None:
            return Fault(time_s, lost, "silent", "torque_off")
        return None

    def fallen(self, motion: Truth | Estimate) -> bool:
        """Whether the root body lies over or lies low."""
        _, x, y, _ = motion.base_orientation.tolist()
        up = 1.0 - 2.0 * (x * x + y * y)  # the body's own vertical against the world's
        return bool(up < self._min_up or motion.base_position[2] < self._min_height)

    def _lost(self, frame: SensorFrame) -> str | None:
        self._missed += 1
        self._missed[frame.joint_valid] = 0
        worst = int(self._missed.argmax())
        if self._missed[worst] > MAX_MISSED_TICKS:
            return self._names[worst]
        if frame.imu_present and frame.imu_age_ns > MAX_BOARD_AGE_NS:
            return "imu"
        for board, age_ns in zip(self._boards, frame.foot_age_ns.tolist(), strict=True):
            if board is not None and age_ns > MAX_BOARD_AGE_NS:
                return board
        return None


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
