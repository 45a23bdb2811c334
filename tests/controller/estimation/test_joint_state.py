"""Joint velocities from encoder samples, through gaps and ages."""

import numpy as np
import pytest

from controller.estimation.joint_state import JointStateFilter
from hil.interface import NEVER_NS, SensorFrame
from hil.servo import COUNTS_PER_RADIAN

RATE = 300
TICK_NS = 1_000_000_000 // RATE


class Encoder:
    """One joint that turns at a constant speed, sampled `age_ns` before each tick."""

    def __init__(self, speed, age_ns=0):
        self.speed, self.age_ns = speed, age_ns
        self.frame = SensorFrame.empty(1)
        self.tick = 0

    def sample(self, valid=True):
        frame = self.frame
        frame.time_ns = self.tick * TICK_NS
        self.tick += 1
        if valid:
            angle = self.speed * (frame.time_ns - self.age_ns) * 1e-9
            frame.joint_position[0] = np.round(angle * COUNTS_PER_RADIAN) / COUNTS_PER_RADIAN
            frame.joint_age_ns[0] = self.age_ns
        else:
            frame.joint_age_ns[0] += TICK_NS
        frame.joint_valid[0] = valid
        return frame

    @property
    def angle(self):
        return self.speed * self.frame.time_ns * 1e-9


def test_velocity_of_a_quantised_ramp():
    encoder, joints = Encoder(2.0), JointStateFilter(1, 0.008, 0.06)
    seen = []
    for _ in range(300):
        joints.update(encoder.sample())
        seen.append(joints.velocity[0])
    assert np.mean(seen[100:]) == pytest.approx(2.0, rel=0.01)
    assert np.std(seen[100:]) < 0.2


def test_a_sample_of_known_age_is_brought_to_the_tick():
    encoder, joints = Encoder(3.0, age_ns=2_000_000), JointStateFilter(1, 0.008, 0.06)
    for _ in range(100):
        joints.update(encoder.sample())
    assert joints.position[0] == pytest.approx(encoder.angle, abs=0.002)


def test_a_silent_joint_coasts_then_holds_and_returns_without_a_jolt():
    encoder, joints = Encoder(1.0), JointStateFilter(1, 0.008, 0.06)
    for _ in range(60):
        joints.update(encoder.sample())
    for _ in range(9):
        joints.update(encoder.sample(valid=False))
    assert joints.position[0] == pytest.approx(encoder.angle, abs=0.005)
    joints.update(encoder.sample())
    assert joints.velocity[0] == pytest.approx(1.0, abs=0.2)
    for _ in range(60):
        joints.update(encoder.sample(valid=False))
    held = joints.position[0]
    assert joints.velocity[0] == 0.0
    joints.update(encoder.sample(valid=False))
    assert joints.position[0] == held


def test_a_joint_that_was_never_heard_stays_finite():
    joints = JointStateFilter(2, 0.008, 0.06)
    frame = SensorFrame.empty(2)
    assert frame.joint_age_ns[0] == NEVER_NS
    for _ in range(10):
        frame.time_ns += TICK_NS
        joints.update(frame)
    np.testing.assert_array_equal(joints.position, 0.0)
    np.testing.assert_array_equal(joints.velocity, 0.0)
