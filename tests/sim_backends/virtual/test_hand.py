"""The hand of a virtual robot: what it holds stays there, and it carries no more than it should."""

import numpy as np
import pytest

from hil.errors import InputError
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.hand import LIFT, Hand
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.robot import VirtualRobot

WEIGHT = 25.7


@pytest.fixture
def held():
    description = load_robot("minibiped", ("plant.draws=null", "plant.substeps=2"))
    plant = Plant(description, 300, 0, nominal_motors(description))
    robot = VirtualRobot(description, plant, 0, 300)
    hand = Hand(robot)
    pose = dict(zip(description.joint_names, description.start_position, strict=True))

    def do(**request):
        """A deed, until the hand says that it is done; the truth then."""
        hand.do(request)
        while (seconds := hand.do({})["seconds"]) > 0:
            robot.clock.sleep_until_ns(robot.clock.now_ns() + round(seconds * 1e9))
        return plant.truth()

    return do, pose


def test_joints_and_torso_go_where_they_are_brought(held):
    do, pose = held
    before = do(lifted=True, joints=pose).base_position[2]
    truth = do(joints={"left_knee": 0.5}, tilt=[0.0, 0.3])
    assert truth.joint_position[3] == pytest.approx(0.5, abs=0.02)
    assert truth.joint_position[9] == pytest.approx(pose["right_knee"], abs=0.02)
    assert 2 * np.arcsin(truth.base_orientation[2]) == pytest.approx(0.3, abs=0.01)
    assert do(tilt=[0.0, 0.0], lifted=False).base_position[2] == pytest.approx(
        before - LIFT, abs=0.002
    )


def test_a_robot_that_is_let_go_stands_with_all_of_its_weight(held):
    do, pose = held
    do(lifted=False, joints=pose)
    do(released=True)
    truth = do()
    assert truth.foot_force.sum() == pytest.approx(WEIGHT, abs=0.5)
    rolls = [name for name in pose if name.endswith("roll")]
    leant = do(free=rolls, tilt=[-0.15, 0.0])
    assert leant.foot_force.sum() == pytest.approx(WEIGHT, abs=1.0)
    assert leant.foot_force[0].sum() > 0.7 * WEIGHT
    assert leant.base_orientation[1] < -0.03


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"joints": {"left_elbow": 0.1}}, "valid: left_hip_yaw"),
        ({"load": {"left:heel": 1.0}}, "valid: left:front_left"),
        ({"tilt": [0.1]}, "needs roll and pitch"),
    ],
)
def test_what_the_robot_does_not_have_is_refused(held, request_, says):
    with pytest.raises(InputError, match=says):
        held[0](**request_)
