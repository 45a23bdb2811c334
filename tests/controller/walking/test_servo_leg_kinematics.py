"""The closed-form leg against MuJoCo's forward kinematics."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.robot_model import RobotModel
from controller.walking.leg_kinematics import LegGeometry, yaw_rows
from hil.robot_files import load_robot

DESCRIPTION = load_robot("minibiped")
MODEL = RobotModel(DESCRIPTION)
LEG = LegGeometry.of(MODEL)


def forward(joints):
    """Ankles from the hips [m], (2, 3), and foot orientations, (2, 3, 3), of an upright base."""
    MODEL.data.qpos[:7] = (0, 0, 0, 1, 0, 0, 0)
    MODEL.data.qpos[MODEL.qpos_addresses] = joints
    mujoco.mj_kinematics(MODEL.model, MODEL.data)
    return MODEL.ankle_positions - MODEL.hip_positions, MODEL.foot_rotations.copy()


joint_angles = st.tuples(
    *(st.floats(max(joint.range[0], 0.1) if "knee" in joint.name else joint.range[0],
                joint.range[1]) for joint in DESCRIPTION.joints)
)  # fmt: skip


@settings(max_examples=200, deadline=None)
@given(joint_angles)
def test_round_trip_over_the_whole_joint_range(joints):
    ankles, feet = forward(joints)
    solved = [LEG.solve(a, f) for a, f in zip(ankles.tolist(), feet.tolist(), strict=True)]
    again, feet_again = forward(np.ravel(solved))
    np.testing.assert_allclose(again, ankles, atol=1e-9)
    np.testing.assert_allclose(feet_again, feet, atol=1e-9)
    np.testing.assert_allclose(np.ravel(solved), joints, atol=1e-6)


def test_geometry_is_read_from_the_model():
    assert pytest.approx(0.110) == LEG.thigh
    assert pytest.approx(0.110) == LEG.shank


def test_a_target_out_of_reach_leaves_the_knee_short_of_straight():
    angles = LEG.solve([0.0, 0.0, -0.5], np.eye(3).tolist())
    assert np.all(np.isfinite(angles))
    assert 0.02 < angles[3] < 0.2


def test_yaw_turns_x_to_the_left():
    np.testing.assert_allclose(np.array(yaw_rows(np.pi / 2)) @ [1, 0, 0], [0, 1, 0], atol=1e-12)
