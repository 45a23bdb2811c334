"""The mapping of a replay: registers as they were written in a run, whatever is measured now."""

import numpy as np

from drivers.calibration import RobotCalibration
from drivers.motor_constants import motor_parameters
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import AppliedCommand, JointCommand, SensorFrame
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN, PWM_FULL, ServoGoals


class ReplayedGoals:
    """Implements `hil.servo.ServoMapping`.

    A recorded goal is an angle in the joint's direction; it becomes counts with the offsets of the
    robot that replays. Gains are registers and stay what they were: nothing is learnt, and
    nothing follows the supply.
    """

    def __init__(self, description: RobotDescription, calibration: RobotCalibration) -> None:
        """Raises InputError for a joint that is not driven in mode position."""
        for joint in description.joints:
            if joint.mode != "position":
                raise InputError(f"joint {joint.name}: only mode position is replayed, "
                                 f"not {joint.mode}")  # fmt: skip
        n = len(description.joints)
        self.applied = AppliedCommand.zeros(n)
        """What the run applied in the next tick; whoever replays fills it before every write."""
        self._offset = calibration.offsets(description.joint_names)
        motors = motor_parameters(description, calibration)
        self._counts_per_radian = motors.direction * COUNTS_PER_RADIAN
        self._goals = ServoGoals(
            position=np.full(n, CENTRE_COUNTS, dtype=np.int64),
            p_gain=np.zeros(n, dtype=np.int64),
            d_gain=np.zeros(n, dtype=np.int64),
            pwm_limit=np.full(n, PWM_FULL, dtype=np.int64),
        )

    def map(self, command: JointCommand, frame: SensorFrame) -> tuple[ServoGoals, AppliedCommand]:
        """The registers of the next tick; both objects are reused by the next call."""
        del command, frame  # What was asked for, and measured, is the run's own affair.
        counts = np.rint((self.applied.goal + self._offset) * self._counts_per_radian)
        np.clip(counts, -CENTRE_COUNTS, CENTRE_COUNTS - 1, out=counts)
        np.add(counts, CENTRE_COUNTS, out=self._goals.position, casting="unsafe")
        self._goals.p_gain[:] = self.applied.p_gain
        return self._goals, self.applied
