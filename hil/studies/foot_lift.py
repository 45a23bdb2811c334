"""How high the feet are lifted in a walk."""

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import SIDES
from hil.studies.walks import step_starts
from hil.trace import Trace

STEPS = 4
"""The last steps, which are looked at."""
EVERY = 3
"""One tick in so many is looked at."""


def foot_lift(description: RobotDescription, trace: Trace) -> float | None:
    """Mean height of the highest point of the swing soles' centres over the last steps [m].

    None in a walk with fewer steps.
    """
    times, stance = step_starts(trace)
    if len(times) < STEPS + 1:
        return None
    model = mujoco.MjModel.from_xml_path(str(description.model_path))
    data = mujoco.MjData(model)
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
           for name in description.joint_names]  # fmt: skip
    angles = model.jnt_qposadr[ids]
    soles = [
        mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, description.feet[side].sole)  # type: ignore[index]
        for side in SIDES
    ]
    begin = np.searchsorted(trace.time_s, times[-STEPS - 1 :])
    highest = []
    for step in range(STEPS):
        swing = soles[1 - int(stance[len(stance) - STEPS - 1 + step])]
        top = 0.0
        for tick in range(int(begin[step]), int(begin[step + 1]), EVERY):
            data.qpos[:3] = trace.base_position[tick]
            data.qpos[3:7] = trace.base_orientation[tick]
            data.qpos[angles] = trace.joint_position[tick]
            mujoco.mj_kinematics(model, data)
            top = max(top, float(data.geom_xpos[swing, 2]))
        highest.append(top)
    return float(np.mean(highest))
