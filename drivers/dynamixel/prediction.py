"""Where joints will be when the goal that is made of a sample acts."""

import numpy as np

from hil.interface import Floats, SensorFrame

LONGEST_PERIOD_S = 0.05
"""Frames further apart are no neighbours: nothing is extrapolated over a pause."""


class JointPrediction:
    """Extrapolates a frame by the time T from sampling to the middle of its goal's life.

        q̂ = q + T·q̇ + T²·q̈/2,   q̂̇ = q̇ + T·q̈,   q̈ = (q̇ − q̇ of the frame before)/period

    T is the sample's age, the way of the goal to the servo, and half a period, since a goal stands
    for one. A spring of stiffness kp on old samples eats kp·T of the damping, and a damper kd on
    them kd·T of the inertia (−kd·q̇(t − T) ≈ −kd·q̇ + kd·T·q̈), which makes a joint look stiffer
    and more damped than was asked: on minibiped's servos by 10 to 25 %.
    """

    def __init__(self, joints: int, latency_s: float) -> None:
        """`latency_s`: from a frame's time to the moment at which the goal acts [s]."""
        self.position = np.zeros(joints)
        """[rad], shape (n,)."""
        self.velocity = np.zeros(joints)
        """[rad/s], shape (n,)."""
        self._latency_s = latency_s
        self._time_ns: int | None = None
        self._before = np.zeros(joints)

    def update(self, frame: SensorFrame) -> None:
        """Take the frame of a tick."""
        before_ns, self._time_ns = self._time_ns, frame.time_ns
        period = 0.0 if before_ns is None else (frame.time_ns - before_ns) * 1e-9
        if not 0.0 < period < LONGEST_PERIOD_S:
            period = 0.0
        velocity = frame.joint_velocity
        delay = np.minimum(frame.joint_age_ns * 1e-9, period) + (self._latency_s + 0.5 * period)
        change: Floats = delay * (velocity - self._before)
        if period:
            change /= period
        else:
            change[:] = 0.0
        self._before[:] = velocity
        np.add(velocity, change, out=self.velocity)
        np.add(frame.joint_position, delay * (velocity + 0.5 * change), out=self.position)
