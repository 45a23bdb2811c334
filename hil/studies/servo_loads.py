"""What each servo of a walk went through, tick by tick, from what the servos measure."""

import numpy as np

from hil.cycle import TickRecord
from hil.description import RobotDescription
from hil.interface import Floats, Limit

HOT = 70.0
"""Temperature at which walking should end [°C]: 10 below where XM430 servos switch off."""


class ServoLoads:
    """A sink: RMS torque and share of saturated ticks, joint by joint, and when one was hot."""

    def __init__(self, description: RobotDescription) -> None:
        self._names = description.joint_names
        self._stall = np.array([joint.torque_limit for joint in description.joints])
        self._square: Floats = np.zeros(len(self._names))
        self._saturated: Floats = np.zeros(len(self._names))
        self._ticks = 0
        self.hot_s: float | None = None
        """Time at which the first servo reached 70 °C [s]."""

    def put(self, record: TickRecord) -> None:
        """Take one walking tick."""
        if record.time_s < 0:
            return
        frame = record.frame
        self._ticks += 1
        self._square += np.square(frame.joint_torque)
        self._saturated += (record.applied.limit & int(Limit.SATURATION)) != 0
        if self.hot_s is None and (frame.joint_temperature >= HOT).any():
            self.hot_s = record.time_s

    def rms(self) -> tuple[str, float]:
        """The joint with the largest RMS torque over its stall torque, and that ratio [%]."""
        return self._worst(np.sqrt(self._square / max(self._ticks, 1)) / self._stall)

    def saturated(self) -> tuple[str, float]:
        """The joint whose goal was most often out of reach of full duty, and how often [%]."""
        return self._worst(self._saturated / max(self._ticks, 1))

    def _worst(self, shares: Floats) -> tuple[str, float]:
        joint = int(np.argmax(shares))
        return self._names[joint], 100.0 * float(shares[joint])
