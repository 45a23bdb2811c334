"""The last hand on a command before the backend: finite, inside the joints' limits."""

from dataclasses import fields

import numpy as np

from hil.description import RobotDescription
from hil.errors import InvalidCommandError
from hil.interface import Ints, JointCommand, Limit

FLAGS: Ints = np.array(
    [Limit.POSITION, Limit.VELOCITY, Limit.STIFFNESS, Limit.DAMPING, Limit.TORQUE], dtype=np.int64
)
"""Flag of each row of a command."""


class JointLimits:
    """Clamps position to the joint's range, velocity and torque to their limits, gains to >= 0.

    A joint that only takes torque (stiffness 0) has no position goal: its range is not applied.
    """

    def __init__(self, description: RobotDescription) -> None:
        joints, n = description.joints, len(description.joints)
        self._names = description.joint_names
        velocity = [joint.velocity_limit for joint in joints]
        torque = [joint.torque_limit for joint in joints]
        position = np.array([joint.range for joint in joints])
        # Rows in the order of JointCommand's fields, so that one operation clamps them all.
        # Gains have no limit but the largest number, so that inf is one that was changed.
        none, all_ = [0.0] * n, [np.finfo(np.float64).max] * n
        self._low = np.array(
            [position[:, 0], np.negative(velocity), none, none, np.negative(torque)]
        )
        self._high = np.array([position[:, 1], velocity, all_, all_, torque])
        self._asked, self._clamped = np.zeros((5, n)), np.zeros((5, n))
        self._changed = np.zeros((5, n), dtype=np.bool_)
        self._flat = self._asked.ravel()
        self._out = JointCommand(*self._clamped)
        self._sound = np.zeros((5, n))
        self.last = JointCommand(*self._sound)
        """The last command that was sound, inside the limits; zeros before the first one."""
        self.flags: Ints = np.zeros(n, dtype=np.int64)
        """`Limit` flags that the last `apply` raised, shape (n,)."""

    def apply(self, command: JointCommand) -> JointCommand:
        """The command inside the limits; reused by the next call.

        Raises InvalidCommandError, naming the joint, if a value is not finite.
        """
        asked, clamped, changed = self._asked, self._clamped, self._changed
        parts = (command.position, command.velocity, command.stiffness, command.damping)
        np.concatenate((*parts, command.torque), out=self._flat)
        np.maximum(asked, self._low, out=clamped)
        np.minimum(clamped, self._high, out=clamped)
        np.not_equal(clamped, asked, out=changed)
        if not np.count_nonzero(changed):
            self.flags[:] = 0
            self._sound[:] = clamped
            return self._out
        if not np.isfinite(asked).all():  # what is not finite is never inside the limits
            raise InvalidCommandError(self._complaint())
        changed[0] &= asked[2] > 0.0
        np.dot(FLAGS, changed, out=self.flags)
        self._sound[:] = clamped
        return self._out

    def _complaint(self) -> str:
        row, joint = np.argwhere(~np.isfinite(self._asked))[0]
        field = fields(JointCommand)[row].name
        return f"command: {field} of {self._names[joint]} is {self._asked[row, joint]}, not finite"
