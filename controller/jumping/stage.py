"""What a stage of a jump is: it says what the body does now, and when the next one may begin.

Every stage has a condition under which it may begin and one under which it is over, so that they
can be put together with each other and with walking (composable controllers, reference [3] of the
seed 004_2880d7939e94ed85).
"""

from dataclasses import dataclass
from typing import Protocol

from controller.jumping.body_tasks import BodyTasks
from controller.jumping.whole_body import BodyTask
from hil.interface import Estimate


@dataclass(frozen=True, slots=True)
class Kit:
    """What all stages work with."""

    tasks: BodyTasks
    dt: float
    """[s]"""
    gravity: float
    """[m/s²]"""
    depth: float
    """Of the crouch, below the height of take-off [m]."""


class Stage(Protocol):
    """One part of a jump."""

    over: bool
    """What this stage was for is done, or can no longer be done."""

    def task(self, estimate: Estimate) -> BodyTask:
        """What the body does in this tick; its model is at the estimate."""
        ...
