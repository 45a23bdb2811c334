"""A made-up walk whose every figure is known."""

import numpy as np

from hil.trace import Trace

RATE = 100
WEIGHT = 100.0


def walk(seconds, step_time=0.5, **columns):
    """A walk along x at 0.2 m/s, steps of one length, all weight evenly on the stance foot."""
    count = round(seconds * RATE)
    time = np.arange(count) / RATE
    steps = (time / step_time).astype(int)
    stance = steps % 2
    forces = np.zeros((count, 2, 4))
    forces[np.arange(count), stance] = WEIGHT / 4
    values = {
        "time_s": time,
        "base_position": np.tile([0.0, 0.0, 0.25], (count, 1)),
        "base_orientation": np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        "com": np.column_stack((0.2 * time, np.zeros(count), np.full(count, 0.2))),
        "com_velocity": np.tile([0.2, 0.0, 0.0], (count, 1)),
        "joint_position": np.zeros((count, 12)),
        "foot_force": forces,
        "toe_force": np.zeros((count, 2)),
        "phase": (time % step_time) / step_time,
        "stance": stance,
        "steps": steps,
        "walking": np.ones(count, bool),
        "foot_flat": np.ones(count, bool),
        "stabilizer_iterations": np.zeros(count, int),
        "stabilizer_limited": np.zeros(count, bool),
        "heading": np.zeros(count),
        "speed": np.full(count, 0.25),
        "lateral": np.zeros(count),
        "water_level": np.zeros(count),
        "control_ns": np.full(count, 200_000),
        "cycle_ns": np.full(count, 500_000),
    }
    return Trace(**{**values, **columns})
