"""Joints in current mode: stiffness and damping made on the host, tick by tick."""

import numpy as np

from drivers.dynamixel.prediction import JointPrediction
from hil.interface import AppliedCommand, Floats, Ints, Limit
from hil.servo import MotorParameters


class HostStiffness:
    """Goal currents of the joints whose servos only regulate a current.

    i* = [kp·(q* − q̂) + kd·(q̇* − q̂̇) + τ]/k_t

    with the predicted state of `JointPrediction`. A goal beyond the current limit, or a current
    that the supply cannot drive at the present speed, is saturation.
    """

    def __init__(self, joints: Ints, motors: MotorParameters, limit: Ints) -> None:
        """`joints`: their indices, (m,). `limit`: largest Goal Current of every joint, (n,)."""
        unit = np.zeros(0) if motors.current_unit is None else motors.current_unit
        self._joints = joints
        self._constant = motors.torque_constant[joints]
        self._resistance = motors.resistance[joints]
        self._per_count = (motors.direction * motors.torque_constant * unit)[joints]
        self._limit = limit[joints]

    def realise(
        self, torque: Floats, ahead: JointPrediction, applied: AppliedCommand, voltage: float
    ) -> Ints:
        """Goal currents [counts], (m,); writes these joints' part of `applied`.

        `torque`: feed-forward of every joint [N·m], (n,); `voltage`: supply [V].
        """
        joints = self._joints
        velocity = ahead.velocity[joints]
        stiffness, damping = applied.stiffness[joints], applied.damping[joints]
        spring = stiffness * (applied.position[joints] - ahead.position[joints])
        spring += damping * (applied.velocity[joints] - velocity)
        asked = spring + torque[joints]
        wanted = asked / self._per_count
        counts = np.rint(np.clip(wanted, -self._limit, self._limit))
        made = counts * self._per_count
        applied.torque[joints] = made - spring
        needed = made / self._constant * self._resistance + self._constant * velocity
        saturated = (np.abs(wanted) > self._limit) | (np.abs(needed) > voltage)
        flags = applied.limit[joints] & ~int(Limit.SATURATION)
        applied.limit[joints] = flags | np.where(saturated, int(Limit.SATURATION), 0)
        return counts.astype(np.int64)
