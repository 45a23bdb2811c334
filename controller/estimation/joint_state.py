"""Joint positions at the tick and joint velocities, from encoder samples of known age."""

import numpy as np

from hil.interface import Floats, SensorFrame


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
        self._sample: Floats = np.zeros(joints)
        self._sample_time = np.full(joints, -np.inf)

    def update(self, frame: SensorFrame) -> None:
        """Take one frame. Joints never received keep the frame's value and velocity 0."""
        age = frame.joint_age_ns * 1e-9
        taken = frame.time_ns * 1e-9 - age
        elapsed = taken - self._sample_time
        fresh = frame.joint_valid & (elapsed > 0.0)
        step = np.where(fresh, elapsed, np.inf)
        rate = (frame.joint_position - self._sample) / step
        gain = np.where(np.isfinite(step), 1.0 - np.exp(-step / self._time), 0.0)
        self.velocity += gain * (rate - self.velocity)
        np.copyto(self._sample, frame.joint_position, where=fresh)
        np.copyto(self._sample_time, taken, where=fresh)
        silent = age > self._coast
        np.copyto(self.velocity, 0.0, where=silent)
        self.position[:] = frame.joint_position + self.velocity * np.minimum(age, self._coast)
