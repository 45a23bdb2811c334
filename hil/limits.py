"""The last hand on a command before the backend: finite, inside the joints' limits."""

from dataclasses import fields

import numpy as np

from hil.description import RobotDescription
from hil.errors import InvalidCommandError
from hil.interface import Ints, JointCommand, Limit


class JointLimits:
    """Clamps position to the joint's range, velocity and torque to their limits, gains to >= 0.

    A joint that only takes torque (stiffness 0) has no position goal: its range is not applied.
    """

    def __init__(self, description: RobotDescription) -> None:
        joints = description.joints
        self._names = description.joint_names
        self._low = np.array([joint.range[0] for joint in joints])
        self._high = np.array([joint.range[1] for joint in joints])
        self._velocity = np.array([joint.velocity_limit for joint in joints])
        self._torque = np.array([joint.torque_limit for joint in joints])
        self._out = JointCommand.zeros(len(joints))
        self.flags: Ints = np.zeros(len(joints), dtype=np.int64)
        """`Limit` flags that the last `apply` raised, shape (n,)."""

    def apply(self, command: JointCommand) -> JointCommand:
        """The command inside the limits; reused by the next call.

        Raises InvalidCommandError, naming the joint, if a value is not finite.
        """
        if not command.is_finite():
            raise InvalidCommandError(self._complaint(command))
        out = self._out
        np.minimum(np.maximum(command.position, self._low), self._high, out=out.position)
        np.minimum(np.maximum(command.velocity, -self._velocity), self._velocity, out=out.velocity)
        np.minimum(np.maximum(command.torque, -self._torque), self._torque, out=out.torque)
        np.maximum(command.stiffness, 0.0, out=out.stiffness)
        np.maximum(command.damping, 0.0, out=out.damping)
        self._flag(command, out)
        return out

    def _flag(self, command: JointCommand, out: JointCommand) -> None:
        flags = self.flags
        clamped = (out.position != command.position) & (out.stiffness > 0.0)
        np.multiply(clamped, int(Limit.POSITION), out=flags)
        flags += (out.velocity != command.velocity) * int(Limit.VELOCITY)
        flags += (out.torque != command.torque) * int(Limit.TORQUE)
        flags += (out.stiffness != command.stiffness) * int(Limit.STIFFNESS)
        flags += (out.damping != command.damping) * int(Limit.DAMPING)

    def _complaint(self, command: JointCommand) -> str:
        for field in fields(command):
            values = getattr(command, field.name)
            bad = np.flatnonzero(~np.isfinite(values))
            if bad.size:
                joint = self._names[bad[0]]
                return f"command: {field.name} of joint {joint} is {values[bad[0]]}, not finite"
        return "command: values too large to add up"
