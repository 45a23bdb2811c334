"""Components of the torque law against MuJoCo and against numbers by hand."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.robot_model import RobotModel
from controller.walking.ankle_limit import SoleLevers, ground_slope, limited, sole_levers
from controller.walking.gravity_compensation import GravityCompensation
from controller.walking.joint_groups import JointGroups
from controller.walking.pose_tracking import PoseTracking
from controller.walking.root_balance import hip_damping, hip_moment, stance_share
from controller.walking.rotations import about_x, about_z
from controller.walking.torque_config import RootBalanceConfig
from controller.walking.virtual_force import VirtualForce

from .conftest import body_state


def test_groups_of_the_human(human, placed):
    groups = placed.groups
    assert len(groups) == 14
    assert groups.names[:4] == ("back", "neck", "left_shoulder", "left_elbow")
    assert [human.joint_names[j] for j in groups.joints[groups.index("right_ankle")]] == [
        "right_ankle_pitch",
        "right_ankle_roll",
    ]


def test_torque_vectors_project_as_mujocos_generalised_forces(human, placed):
    """A torque on one body against its parent does the work that MuJoCo's xfrc_applied does."""
    robot, groups, model = placed.robot, placed.groups, placed.model
    rng = np.random.default_rng(0)
    torques = rng.normal(size=(len(groups), 3))
    expected = np.zeros(model.nv)
    for k in range(len(groups)):
        for body, sign in ((groups.child[k], 1), (groups.parent[k], -1)):
            mujoco.mj_applyFT(
                model,
                placed.reference,
                np.zeros(3),
                sign * torques[k],
                placed.reference.xpos[body],
                int(body),
                expected,
            )
    projected = groups.project(torques, robot.joint_axes)
    assert projected == pytest.approx(expected[robot.dof_addresses])
    assert expected[:6] == pytest.approx(np.zeros(6), abs=1e-12)


def test_gravity_compensation_is_mujocos_bias_outside_the_stance_leg(human, placed):
    gravity = GravityCompensation(placed.robot, placed.groups)
    for stance, side in enumerate(("left", "right")):
        joints = placed.groups.project(gravity.torques(stance), placed.robot.joint_axes)
        bias = placed.reference.qfrc_bias[placed.robot.dof_addresses]
        leg = [
            name.startswith(side) and not name.startswith((f"{side}_sh", f"{side}_el"))
            for name in human.joint_names
        ]
        assert joints == pytest.approx(np.where(leg, 0.0, bias), abs=1e-9)


def test_pelvis_receives_the_root_torque_whatever_the_share():
    rng = np.random.default_rng(4)
    root, swing, back = rng.normal(size=(3, 3))
    moment = hip_moment(root, swing, back[None])
    for load in (0.0, 300.0, 700.0):
        stance_part, swing_part = stance_share(load, 700.0 - load)
        reactions = -(stance_part * moment) - (swing + swing_part * moment) - back
        assert reactions == pytest.approx(root)


def test_no_foot_on_the_floor_carries_nothing():
    assert stance_share(0.0, 0.0) == (0.0, 0.0)
    assert stance_share(600.0, 200.0) == (0.75, 0.25)


def test_hip_damping_by_hand():
    config = RootBalanceConfig(scale=(1, 1, 1), hip_damping=2.0, hip_damping_limit=1.0)
    assert hip_damping(config, np.array([3.0, 0.0, -4.0])) == pytest.approx([-10.0, 0.0, 10.0])
    assert hip_damping(config, np.array([0.0, 0.5, 0.0])) == pytest.approx([0.0, -0.5, 0.0])


def tracking_of(human, human_config, state, heading, lead=0.0):
    robot = RobotModel(human)
    groups = JointGroups(human, robot)
    tracking = PoseTracking(robot, groups, human_config, human_config.gains[300], lead)
    robot.set_state(state)
    tracking.set_frames(heading, {})
    return tracking, groups


def test_tracking_torque_by_hand(human, human_config):
    """A head rolled by 0.1 rad and a knee bent by 0.2 rad that moves at 0.5 rad/s."""
    names = human.joint_names
    state = body_state(human, np.zeros(len(names)))
    state.joint_position[names.index("neck_roll")] = 0.1
    state.joint_position[names.index("left_knee")] = 0.2
    state.joint_velocity[names.index("left_knee")] = 0.5
    tracking, groups = tracking_of(human, human_config, state, np.eye(3))
    torques = tracking.torques()
    assert torques[groups.index("neck")] == pytest.approx([-300 * 0.1, 0.0, 0.0])
    assert torques[groups.index("left_knee")] == pytest.approx([0, -300 * 0.2 - 20 * 0.5, 0])
    # The foot is tracked in the heading frame with its absolute angular velocity.
    assert torques[groups.index("left_ankle")] == pytest.approx([0, -30 * 0.2 - 2 * 0.5, 0])


def test_lead_predicts_the_error_by_one_tick(human, human_config):
    names = human.joint_names
    state = body_state(human, np.zeros(len(names)))
    state.joint_velocity[names.index("left_knee")] = 0.5
    tracking, groups = tracking_of(human, human_config, state, np.eye(3), lead=0.01)
    knee = tracking.torques()[groups.index("left_knee")]
    assert knee == pytest.approx([0.0, -(300 * 0.01 + 20) * 0.5, 0.0])


def test_root_rate_is_the_mean_of_two_ticks(human, human_config):
    state = body_state(human, np.zeros(len(human.joints)))
    state.base_angular_velocity[:] = (0.0, 0.4, 0.0)
    tracking, _ = tracking_of(human, human_config, state, np.eye(3))
    assert tracking.torques()[-1] == pytest.approx([0.0, -90 * 0.2, 0.0])
    assert tracking.torques()[-1] == pytest.approx([0.0, -90 * 0.4, 0.0])


def test_yaw_of_the_torso_is_weak_in_any_heading(human, human_config):
    """Scales act in the heading frame: whichever way the robot faces."""
    heading = about_z(np.pi / 2)
    state = body_state(human, np.zeros(len(human.joints)))
    state.base_orientation = np.array([np.cos(0.8), 0.0, 0.0, np.sin(0.8)])
    tracking, groups = tracking_of(human, human_config, state, heading)
    yaw = 1.6 - np.pi / 2
    assert tracking.torques()[groups.index("back")] == pytest.approx([0, 0, -0.2 * 1000 * yaw])
    tracking.target[groups.index("back")] = about_x(0.1) @ about_z(yaw)
    torque = heading.T @ tracking.torques()[groups.index("back")]
    assert torque == pytest.approx([1000 * 0.1, 0.0, 0.0])


def virtual_force(human, human_config):
    robot = RobotModel(human)
    groups = JointGroups(human, robot)
    back = groups.index("back")
    robot.set_state(body_state(human, np.zeros(len(human.joints))))
    return VirtualForce(human_config.virtual_force, robot, groups, back), groups


def test_virtual_force_is_proportional_to_the_speed_error_and_capped(human, human_config):
    virtual, _ = virtual_force(human, human_config)
    force = virtual.force(np.array([0.5, 0.0]), np.array([0.45, 0.02]), np.eye(3))
    assert force == pytest.approx([70.4 * 30 * 0.05, -70.4 * 20 * 0.02, 0.0])
    turned = virtual.force(np.array([0.5, 0.0]), np.array([0.45, 0.0]), about_z(np.pi / 2))
    assert turned == pytest.approx([0.0, 70.4 * 30 * 0.05, 0.0], abs=1e-9)
    capped = virtual.force(np.array([2.0, 0.0]), np.zeros(2), np.eye(3))
    assert capped[0] == pytest.approx(0.29 * 70.4 * 9.81)


def test_levers_of_the_upright_body_by_hand(human, human_config):
    """Zero pose, z: hip .985, knee .515, ankle .055; thigh .775, shank .305, pelvis 1.035."""
    virtual, _ = virtual_force(human, human_config)
    hip = 12.9 * (1.035 - 0.985) / 45.2
    knee = (12.9 * (1.035 - 0.515) + 6.6 * (0.775 - 0.515)) / 45.2
    ankle = (12.9 * 0.98 + 6.6 * 0.72 + 3.2 * 0.25) / 45.2
    assert virtual.lever_heights() == pytest.approx(np.array([[ankle] * 2, [knee] * 2, [hip] * 2]))


def test_virtual_torques_push_the_body_forward(human, human_config):
    virtual, groups = virtual_force(human, human_config)
    torques = np.zeros((len(groups), 3))
    virtual.add_torques(torques, np.array([100.0, 0.0, 0.0]), np.array([1.0, 0.0]))
    ankle = torques[groups.index("left_ankle")]
    assert ankle[1] == pytest.approx(-100 * (12.9 * 0.98 + 6.6 * 0.72 + 3.2 * 0.25) / 45.2)
    assert not torques[groups.index("right_ankle")].any()
    # The torso, 0.23 m above its joint, is pushed forward itself.
    assert torques[groups.index("back"), 1] == pytest.approx(100 * 22.5 * 0.23 / 45.2)


def test_sole_of_the_human(human):
    levers = sole_levers(RobotModel(human), human.feet["left"])
    found = (levers.front, levers.rear, levers.half_width, levers.height)
    assert found == pytest.approx((0.125, 0.05, 0.025, 0.053))


LEVERS = SoleLevers(front=0.125, rear=0.05, half_width=0.025, height=0.05)
TORQUE = st.floats(-300, 300)
SLOPE = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))


@given(st.floats(1, 1500), SLOPE, TORQUE, TORQUE, st.floats(0.05, 1))
def test_ankle_torque_keeps_the_pressure_within_its_part_of_the_sole(
    load, slope, pitch, roll, fraction
):
    """By the moments about the ankle of ankle torque and ground force, which balance."""
    p, r = limited(LEVERS, fraction, load, slope, pitch, roll)
    force = load * np.array([*slope, 1.0])
    pressure = np.array([p / load - 0.05 * slope[0], -r / load - 0.05 * slope[1], -0.05])
    assert (np.array([r, p]) + np.cross(pressure, force)[:2]) == pytest.approx([0, 0], abs=1e-9)
    assert -0.05 * fraction - 1e-9 <= pressure[0] <= 0.125 * fraction + 1e-9
    assert abs(pressure[1]) <= 0.025 * fraction + 1e-9
    # A torque within the bounds passes unchanged.
    assert limited(LEVERS, fraction, load, slope, p, r) == pytest.approx((p, r))


def test_ground_force_points_at_the_centre_of_mass_in_the_foots_heading():
    """A body 0.3 m ahead of and 0.1 m left of a foot that is turned left by a quarter."""
    com, ankle = np.array([2.3, 1.1, 1.05]), np.array([2.0, 1.0, 0.05])
    slope = ground_slope(LEVERS, com, ankle, about_z(np.pi / 2) @ about_x(0.2))
    assert slope == pytest.approx((0.1 / 1.05, -0.3 / 1.05))
