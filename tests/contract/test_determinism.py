"""A seed decides everything in lockstep: two whole walks are the same to the last bit."""

import numpy as np
import pytest

from hil.compose import build
from hil.loop import Loop
from hil.request import RunRequest


class Trajectory:
    """Keeps what the joints did, and what the sensors said, in every tick."""

    def __init__(self):
        self.rows = []

    def put(self, record):
        frame = record.frame
        parts = (
            record.truth.joint_position, frame.joint_position, frame.foot_force.ravel(),
            frame.imu_orientation, frame.imu_linear_acceleration, record.command.position,
        )  # fmt: skip
        self.rows.append(np.concatenate(parts))


def walk(backend, seed):
    session = build(RunRequest(backend=backend, duration_s=0.6, seed=seed))
    trajectory = Trajectory()
    try:
        session.backend.open()
        outcome = Loop(session, (trajectory,)).run()
    finally:
        session.close()
    assert not outcome.faults
    return np.array(trajectory.rows)


@pytest.mark.parametrize("backend", ["mujoco", "bus"])
def test_one_seed_gives_one_walk_and_another_seed_another(backend):
    first, second, other = (walk(backend, seed) for seed in (5, 5, 6))
    assert len(first) > 2.0 * 300
    np.testing.assert_array_equal(first, second)
    assert (first[-1] != other[-1]).any()
