"""The last look at a command before it becomes registers."""

from collections.abc import Sequence

import numpy as np

from hil.errors import InvalidCommandError
from hil.interface import JointCommand

_FIELDS = ("position", "velocity", "stiffness", "damping", "torque")


def require_sound(command: JointCommand, joint_names: Sequence[str]) -> None:
    """Raises InvalidCommandError for a wrong shape or a value that is not finite."""
    shape = (len(joint_names),)
    if command.is_finite() and all(getattr(command, name).shape == shape for name in _FIELDS):
        return
    for name in _FIELDS:
        values = getattr(command, name)
        if values.shape != shape:
            raise InvalidCommandError(
                f"command {name} has shape {values.shape}, the robot has {shape[0]} joints"
            )
        for joint, value in zip(joint_names, values, strict=True):
            if not np.isfinite(value):
                raise InvalidCommandError(f"joint {joint}: commanded {name} is {value}")
