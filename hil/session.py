"""The parts of one run, put together by the composition root and used by the loop."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from hil.description import RobotDescription
from hil.interface import Backend, Controller, Estimator, World
from hil.request import RunRequest

if TYPE_CHECKING:
    from hil.jump_report import JumpReview


@dataclass(frozen=True, slots=True)
class Session:
    """A robot ready to run, known only through the interface."""

    request: RunRequest
    """Resolved: nothing is left to the robot's defaults."""
    description: RobotDescription
    backend: Backend
    """Not open yet; the run opens and closes it."""
    estimator: Estimator
    controller: Controller
    world: World | None = None
    """The simulated surrounding; none on a real robot."""
    meta: dict[str, Any] = field(default_factory=dict)
    """Facts for meta.json that only the composition root knows."""
    figures: Callable[[], dict[str, float | None]] = dict
    """Report figures that the backend's statistics leave open, such as those of a virtual robot's
    servos; asked for once, after the session is closed."""
    begin_faults: Callable[[int], None] | None = None
    """Tells a virtual robot when T = 0 is [ns on the backend's clock], where its faults wait for
    it."""
    jump: "JumpReview | None" = None
    """Of a jump: what its report keys and its picture are made from."""
    watch: Callable[[], str | None] | None = None
    """Asked after every tick with torque on: what else is wrong, or nothing."""
    closers: tuple[Callable[[], None], ...] = ()
    """End what the composition root started, in this order, after the backend is closed."""

    def close(self) -> None:
        """Close the backend, then everything that was started for it. Safe to call twice."""
        with ExitStack() as closing:  # runs them last to first, each even if one before it raised
            for closer in reversed((self.backend.close, *self.closers)):
                closing.callback(closer)
