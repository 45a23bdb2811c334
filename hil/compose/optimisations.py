"""What the studies need of the controller's costs and search spaces."""

from collections.abc import Callable

from controller.search import gain_objective, gain_space, gait_objective, gait_space, style_space
from controller.search.gait_space import GainLimits
from controller.search.motion import MotionMeter
from hil.errors import InputError
from hil.session import Session
from sim_backends.plant import Plant

__all__ = [
    "GainLimits",
    "MotionMeter",
    "drag_meter",
    "gain_objective",
    "gain_space",
    "gait_objective",
    "gait_space",
    "style_space",
]


def drag_meter(session: Session) -> Callable[[], float]:
    """Asks a simulated robot what its liquid does to the joints [N·m]; 0 on dry land.

    Raises InputError for a robot whose body is not in this process.
    """
    if not isinstance(session.world, Plant):
        raise InputError("the drag on a robot is known only where its body is simulated: lockstep")
    return session.world.immersion.drag_torque
