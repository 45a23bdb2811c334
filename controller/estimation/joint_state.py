"""Joint positions at the tick and joint velocities, from encoder samples of known age."""

import math

import numpy as np

from hil.interface import Floats, SensorFrame

JointSample = tuple[float, float, float]
"""Position [rad] and time [s] of the last sample, and the filtered velocity [rad/s]."""


class JointStateFilter:
    """Positions brought to the frame's time, velocities from differences of samples.

    Sample i of a joint was taken at t_i = frame time − age. A new sample gives
    v ← v + (1 − e^(−Δt/τ))·((q_i − q_{i−1})/Δt − v), Δt = t_i − t_{i−1}; the position at the
    frame's time is q_i + v·age. So a joint that goes silent coasts on its last velocity, up to
    `coast_time`, and then holds with velocity 0.
    """

    def __init__(self, joints: int, velocity_time: float, coast_time: float) -> None:
        self._time = velocity_time
        self._coast = coast_time
        self.position: Floats = np.zeros(joints)
        """[rad], shape (n,)."""
        self.velocity: Floats = np.zeros(joints)
        """[rad/s], shape (n,)."""
        self._last: list[JointSample] = [(0.0, -math.inf, 0.0)] * joints

    def update(self, frame: SensorFrame) -> None:
        """Take one frame. Joints never received keep the frame's value and velocity 0.

        Joint by joint in plain numbers: a dozen joints take half the time of array operations.
        """
        now, coast = frame.time_ns * 1e-9, self._coast
        ages = frame.joint_age_ns.tolist()
        found = zip(frame.joint_position.tolist(), ages, frame.joint_valid.tolist(), strict=True)
        positions, velocities = [], []
        gain = last_elapsed = 0.0
        for joint, (angle, age_ns, valid) in enumerate(found):
            age = age_ns * 1e-9
            sample, time, velocity = self._last[joint]
            elapsed = now - age - time
            if valid and elapsed > 0.0:
                if elapsed != last_elapsed:
                    last_elapsed = elapsed
                    gain = 1.0 - math.exp(-elapsed / self._time)
                velocity += gain * ((angle - sample) / elapsed - velocity)
                sample, time = angle, now - age
            if age > coast:
                age, velocity = coast, 0.0
            self._last[joint] = (sample, time, velocity)
            velocities.append(velocity)
            positions.append(angle + velocity * age)
        self.position[:] = positions
        self.velocity[:] = velocities
