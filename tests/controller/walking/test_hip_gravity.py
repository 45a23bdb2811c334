"""The stance hip's gravity term against MuJoCo's gravity torque."""

import mujoco
import numpy as np
import pytest

from controller.walking.hip_gravity import HipGravity


@pytest.mark.parametrize(("stance", "side"), [(0, "left"), (1, "right")])
def test_stance_hip_bears_everything_above_it(placed, stance, side):
    """Weights of all bodies but the stance leg's, by hand from the body positions."""
    robot, groups, data = placed.robot, placed.groups, placed.robot.data
    model = robot.model
    hip = data.xanchor[model.joint(f"{side}_hip_pitch").id]
    moment = np.zeros(3)
    for body in range(1, model.nbody):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body)
        if name.startswith(side) and name.endswith(("thigh", "shank", "foot", "toes")):
            continue
        weight = np.array([0.0, 0.0, -model.body_mass[body] * robot.gravity])
        moment += np.cross(data.xipos[body] - hip, weight)
    gravity = HipGravity(robot, groups)
    assert gravity.torque(stance, 1.0, 0.0) == pytest.approx([*moment[:2], 0.0])
    assert gravity.torque(stance, 0.5, 0.0) == pytest.approx([*(0.5 * moment[:2]), 0.0])


def test_ground_carries_the_loaded_swing_foot(placed):
    robot = placed.robot
    gravity = HipGravity(robot, placed.groups)
    hip = robot.hips[0]
    relief = np.cross(robot.ankles[1] - hip, (0.0, 0.0, 300.0))
    difference = gravity.torque(0, 1.0, 300.0) - gravity.torque(0, 1.0, 0.0)
    assert difference == pytest.approx([*relief[:2], 0.0])
