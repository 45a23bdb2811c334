"""The last hand on a command before the backend: finite, inside the joints' limits."""

from dataclasses import fields

import numpy as np

from hil.description import RobotDescription
from hil.errors import InvalidCommandError
from hil.interface import Bools, Floats, Ints, JointCommand, Limit

FLAGS: Ints = np.array(
    [Limit.POSITION, Limit.VELOCITY, Limit.STIFFNESS, Limit.DAMPING, Limit.TORQUE], dtype=np.int64
)
"""Flag of each row of a command."""


class JointLimits:
    """Clamps position to the joint's range, velocity and torque to their limits, gains to >= 0.

    With a rate f, a position goal also moves no further in a tick than c·v_max/f from the last
    one, where v_max is the joint's velocity limit and c `safety.goal_speed_max`:

        q_k = clip(clip(q, range), q_{k-1} ± c·v_max/f)

    which is inside the range, since q_{k-1} is. A joint that only takes torque (stiffness 0) has no
    position goal: its range is not applied.
    """

    def __init__(self, description: RobotDescription, rate_hz: int | None = None) -> None:
        """`rate_hz`: of the ticks, for a robot of position goals; without it they may jump."""
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
        self._step: Floats | None = None
        """How far a position goal may move in a tick [rad], (n,)."""
        if rate_hz is not None:
            self._step = description.safety.goal_speed_max / rate_hz * np.array(velocity)
        self._near, self._far = np.full(n, -np.inf), np.full(n, np.inf)
        """Where the next position goals may be; the first ones may be anywhere in the range."""
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
        if self._step is not None:
            np.maximum(clamped[0], self._near, out=clamped[0])
            np.minimum(clamped[0], self._far, out=clamped[0])
        np.not_equal(clamped, asked, out=changed)
        if np.count_nonzero(changed):
            if not np.isfinite(asked).all():  # what is not finite is never inside the limits
                raise InvalidCommandError(self._complaint())
            self._tell(asked, clamped, changed)
        else:
            self.flags[:] = 0
        self._sound[:] = clamped
        if self._step is not None:
            np.subtract(clamped[0], self._step, out=self._near)
            np.add(clamped[0], self._step, out=self._far)
        return self._out

    def _tell(self, asked: Floats, clamped: Floats, changed: Bools) -> None:
        """Flags of what was changed; a goal that was held back moved too fast, or too far, or
        both."""
        ranged = np.clip(asked[0], self._low[0], self._high[0])
        changed[1] |= clamped[0] != ranged
        changed[0] = ranged != asked[0]
        changed[0] &= asked[2] > 0.0
        np.dot(FLAGS, changed, out=self.flags)

    def _complaint(self) -> str:
        row, joint = np.argwhere(~np.isfinite(self._asked))[0]
        field = fields(JointCommand)[row].name
        return f"command: {field} of {self._names[joint]} is {self._asked[row, joint]}, not finite"
