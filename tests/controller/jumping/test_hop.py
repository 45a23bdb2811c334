"""The hop of a servo robot: its gesture, what it asks of the servos, and what follows it."""

from dataclasses import replace

import numpy as np
import pytest

from controller.estimation.sensors import empty_estimate
from controller.jumping.feasibility import demand
from controller.jumping.hop_gesture import HopGesture, from_rest
from controller.jumping.hop_rehearsal import rehearse_hop
from controller.jumping.hop_settings import HopSettings
from controller.jumping.jump_curves import RATE
from controller.jumping.path import JumpTarget
from controller.jumping.servo_hop import ServoHop
from controller.robot_model import RobotModel
from hil.errors import InputError
from hil.interface import Reference
from hil.robot_files import load_robot

SPOT = (0.0, 0.0, 0.0)
SETTINGS = HopSettings(windup_time=6.0)
DEPTH, SHALLOW = 0.034, 0.02
"""Of a push, and of one that knees alone can do from the same take-off [m]."""


@pytest.fixture(scope="module")
def minibiped():
    return load_robot("minibiped")


@pytest.fixture(scope="module")
def robot(minibiped):
    return RobotModel(minibiped)


@pytest.fixture(scope="module")
def curves(minibiped):
    return rehearse_hop(minibiped, JumpTarget(SPOT, 0.075, DEPTH), SETTINGS)


def test_a_motor_at_full_duty_begins_at_rest_and_ends_at_nearly_even_speed():
    ways = np.array([from_rest(u, 0.2) for u in np.linspace(0.0, 1.0, 101)])
    assert ways[0] == 0.0 and ways[-1] == pytest.approx(1.0)
    speed = np.diff(ways)
    assert (np.diff(speed) > 0.0).all() and speed[0] < 0.05 * speed[-1]
    assert speed[-1] == pytest.approx(speed[-20], rel=0.02)


@pytest.mark.parametrize("rise", [0.0, 0.1, 0.3])
def test_toes_stay_where_they_are_while_heels_rise(minibiped, robot, rise):
    settings = replace(SETTINGS, heel_rise=rise)
    gesture = HopGesture(minibiped, robot, settings, SHALLOW)
    places = []
    for share in np.linspace(0.0, 1.0, 9):
        robot.set_state(gesture.posture(gesture.shape(float(share))))
        places.append(robot.corner_positions.copy())
    corners = np.array(places)
    assert np.abs(corners[:, :, :2] - corners[0, :, :2]).max() < 1e-5
    heels = corners[:, :, 2:, 2]
    assert np.abs(heels[0]).max() < 1e-5
    assert heels[-1].min() == pytest.approx(0.12 * np.sin(rise), abs=1e-5)


@pytest.mark.parametrize("depth", [0.02, 0.034])
def test_the_body_rises_as_far_as_it_is_told(minibiped, robot, depth):
    gesture = HopGesture(minibiped, robot, SETTINGS, depth)
    rise = gesture.height(gesture.shape(1.0)) - gesture.height(gesture.shape(0.0))
    assert rise == pytest.approx(depth, abs=1e-5)


def test_the_body_leaves_with_the_velocity_of_its_path(curves):
    path = curves.plan.path
    speed = (curves.com[-1] - curves.com[-2])[2] * RATE
    assert speed == pytest.approx(path.take_off_velocity[2], rel=0.03)
    assert curves.com[-1][2] == pytest.approx(path.take_off[2], abs=1e-4)


def test_the_torques_do_the_work_that_body_and_rotors_have(robot, curves):
    """∫ τ·dq = m·g·Δz + ½·Σ J·q̇² + ½·m·v² while the feet are flat: rotors have the most of the
    kinetic energy."""
    last = curves.push_begin + int(SETTINGS.heel_begin * (len(curves.com) - curves.push_begin)) - 1
    torque, way = curves.torque[:last], np.diff(curves.position[: last + 1], axis=0)
    work = float((torque * way).sum())
    rise = curves.com[last, 2] - curves.com[0, 2]
    armature = robot.model.dof_armature[robot.dof_addresses]
    rotors = 0.5 * float((armature * curves.velocity[last] ** 2).sum())
    body = 0.5 * robot.mass * float(np.square((curves.com[last] - curves.com[last - 1]) * RATE)[2])
    assert work == pytest.approx(robot.weight * rise + rotors + body, rel=0.05)


def test_heels_that_rise_spare_the_knees(minibiped):
    target, knee = JumpTarget(SPOT, 0.075, SHALLOW), minibiped.joint_names.index("left_knee")
    with_heels, flat = (
        rehearse_hop(minibiped, target, replace(SETTINGS, heel_rise=rise)).velocity[:, knee]
        for rise in (SETTINGS.heel_rise, 0.0)
    )
    assert np.abs(with_heels).max() < 0.9 * np.abs(flat).max()


def test_a_longer_flight_asks_more_of_the_servos(minibiped):
    ratios = [
        demand(minibiped, rehearse_hop(minibiped, JumpTarget(SPOT, airtime, DEPTH), SETTINGS)).ratio
        for airtime in (0.06, 0.075, 0.1)
    ]
    assert ratios == sorted(ratios) and ratios[0] < 1.0 < ratios[-1]


@pytest.mark.parametrize(
    ("target", "named"),
    [
        (JumpTarget((0.05, 0.0, 0.0), 0.075, DEPTH), "--target: .* on the spot"),
        (JumpTarget(SPOT, 0.075, 0.2), "--push-depth: the knees bend for 0.0"),
        (JumpTarget(SPOT, 0.02, DEPTH), "--airtime"),
    ],
    ids=["forward", "deep", "short"],
)
def test_what_has_no_gesture_is_refused(minibiped, target, named):
    with pytest.raises(InputError, match=named):
        rehearse_hop(minibiped, target, SETTINGS)


def test_legs_are_drawn_up_at_take_off_and_stand_after_the_landing(minibiped, curves):
    hop = ServoHop(minibiped, 300, curves)
    estimate, goals = empty_estimate(len(minibiped.joints)), []
    push, air = len(curves.position), 25
    for tick in range(push + air + curves.landing_steps + curves.return_steps):
        estimate.contact[:] = not push <= tick < push + air
        goals.append(hop.step(estimate, Reference()).position.copy())
    assert goals[push] == pytest.approx(curves.drawn_up)
    assert goals[push + air - 1] == pytest.approx(curves.drawn_up)
    assert goals[push + air + curves.landing_steps] == pytest.approx(curves.landed, abs=1e-3)
    assert goals[-1] == pytest.approx(minibiped.start_position, abs=1e-3)
