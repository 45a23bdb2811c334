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
        self._age, self._taken, self._elapsed, self._change, self._gain = np.zeros((5, joints))
        self._fresh = np.zeros(joints, dtype=np.bool_)

    def update(self, frame: SensorFrame) -> None:
        """Take one frame. Joints never received keep the frame's value and velocity 0."""
        age, velocity = self._age, self.velocity
        np.multiply(frame.joint_age_ns, 1e-9, out=age)
        self._take_samples(frame)
        if age.max() > self._coast:
            velocity[age > self._coast] = 0.0
            np.minimum(age, self._coast, out=age)
        np.multiply(velocity, age, out=self.position)
        self.position += frame.joint_position

    def _take_samples(self, frame: SensorFrame) -> None:
        """Move the velocities of the joints that have a new sample."""
        taken, elapsed, fresh = self._taken, self._elapsed, self._fresh
        change, gain = self._change, self._gain
        np.subtract(frame.time_ns * 1e-9, self._age, out=taken)
        np.subtract(taken, self._sample_time, out=elapsed)
        np.greater(elapsed, 0.0, out=fresh)
        fresh &= frame.joint_valid
        np.copyto(elapsed, np.inf, where=~fresh)  # no change, and no division by zero
        np.subtract(frame.joint_position, self._sample, out=change)
        change /= elapsed
        change -= self.velocity
        np.divide(elapsed, -self._time, out=gain)
        np.exp(gain, out=gain)
        np.subtract(1.0, gain, out=gain)
        change *= gain
        np.add(self.velocity, change, out=self.velocity, where=fresh)
        np.copyto(self._sample, frame.joint_position, where=fresh)
        np.copyto(self._sample_time, taken, where=fresh)
