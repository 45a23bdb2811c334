"""How a servo robot comes to rest: it sits down on bent knees; falling, it folds up, soft."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import JointCommand
from hil.safety.decision import Action
from hil.smoothstep import smoothstep

REST_S = 0.3
"""Time in the sitting pose before torque goes off."""
LAND_S = 0.4
"""Time from the prediction of a fall until torque goes off: a robot of 0.25 m falls as long."""
LAND_RAMP_S = 0.2
LAND_STIFFNESS = 0.3
"""Share of the stiffness while landing: joints give way, gears live longer (assumed)."""


def sit_time_s(description: RobotDescription) -> float:
    """Time from the first tick of the way down to torque off [s]; 0 for a robot without it."""
    return 0.0 if description.sit is None else description.sit.time + REST_S


class WayDown:
    """Moves every joint from its last goal to the sitting pose, smoothly, and holds it.

    The share of the way is 3s² − 2s³; the feed-forward torque fades with it, since it belonged to
    another pose. Landing is the same, faster and softer.
    """

    def __init__(self, description: RobotDescription, rate_hz: int) -> None:
        n = len(description.joints)
        self._command = JointCommand.zeros(n)
        self._start, self._torque = np.zeros(n), np.zeros(n)
        self._stiffness = np.array([joint.stiffness for joint in description.joints])
        self._damping = np.array([joint.damping for joint in description.joints])
        sit = description.sit
        pose = {} if sit is None else sit.joints
        self._goal = np.array([pose.get(name, 0.0) for name in description.joint_names])
        sit_s = 0.0 if sit is None else sit.time
        self._ticks = {
            Action.SIT: max(1, round(sit_s * rate_hz)),
            Action.LAND: max(1, round(LAND_RAMP_S * rate_hz)),
        }
        self._action: Action | None = None
        self._done = 0

    def command(self, action: Action, last: JointCommand) -> JointCommand:
        """The command of the next tick of SIT or LAND; `last` is the one that was sent before."""
        if action is not self._action:
            self._action, self._done = action, 0
            self._start[:], self._torque[:] = last.position, last.torque
            share = LAND_STIFFNESS if action is Action.LAND else 1.0
            self._command.stiffness[:] = share * self._stiffness
            self._command.damping[:] = self._damping
        ticks = self._ticks[action]
        self._done = min(self._done + 1, ticks)
        s = smoothstep(self._done / ticks)
        np.subtract(self._goal, self._start, out=self._command.position)
        self._command.position *= s
        self._command.position += self._start
        np.multiply(self._torque, 1.0 - s, out=self._command.torque)
        return self._command
