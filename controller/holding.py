"""Holding one pose: what a robot does that stands, or sits, and does not walk."""

from collections.abc import Sequence

import numpy as np

from hil.description import RobotDescription
from hil.interface import Estimate, JointCommand, Reference, WalkStatus


class PoseHolder:
    """The same goal in every tick, with the description's stiffness and damping.

    No feedback and no feed-forward: what the joints do not hold by themselves shows.
    """

    def __init__(self, description: RobotDescription, pose: Sequence[float]) -> None:
        """`pose` in joint order [rad]."""
        self.status = WalkStatus()
        self._command = JointCommand.zeros(len(description.joints))
        self._command.position[:] = np.array(pose)
        self._command.stiffness[:] = [joint.stiffness for joint in description.joints]
        self._command.damping[:] = [joint.damping for joint in description.joints]

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of this tick. The returned object is the same in every call."""
        del estimate, reference  # The pose is held whatever the robot does.
        return self._command
