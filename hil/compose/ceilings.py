"""Ceilings of gains from the robot's model, in the poses of a recorded walk."""

import numpy as np

from controller.walking.gain_ceiling import GainCeiling
from controller.walking.linear_stance import StancePose
from controller.walking.servo_ceiling import ServoCeiling
from drivers.assembly import bus_budgets
from hil.description import RobotDescription
from hil.trace import Trace


def gain_ceiling(description: RobotDescription, trace: Trace, poses: int) -> GainCeiling:
    """The ceiling of a torque robot in poses of the last strides of a walk."""
    return GainCeiling(description, _poses(trace, poses))


def servo_ceiling(
    description: RobotDescription, trace: Trace, poses: int, armature: float | None
) -> ServoCeiling:
    """The ceilings of a servo robot's joints there; `armature` replaces the model's [kg·m²]."""
    return ServoCeiling(description, _poses(trace, poses), armature)


def bus_delay_s(description: RobotDescription) -> float:
    """From a sample of the servos to the moment its goals act, without the tick's own half [s]."""
    return 1e-9 * max(budget.needed_ns for budget in bus_budgets(description))


def _poses(trace: Trace, count: int) -> list[StancePose]:
    """Moments evenly spread over the last four steps that a walk finished."""
    first = int(np.searchsorted(trace.steps, max(int(trace.steps[-1]) - 4, 0)))
    last = int(np.searchsorted(trace.steps, trace.steps[-1]))
    ticks = np.linspace(first, max(last - 1, first), count).astype(int)
    return [
        StancePose(
            trace.base_orientation[tick],
            trace.joint_position[tick],
            float(trace.heading[tick]),
            int(trace.stance[tick]),
        )
        for tick in ticks.tolist()
    ]
