"""What actuators can do is known before anything moves."""

import numpy as np
import pytest

from controller.jumping.feasibility import available_torque, demand, require_feasible
from controller.jumping.path import JumpTarget
from controller.jumping.rehearsal import rehearse
from hil.errors import InputError
from hil.robot_files import load_robot


@pytest.fixture(scope="module")
def human():
    return load_robot("human")


def test_the_rehearsal_reaches_take_off_velocity_and_keeps_the_feet(human):
    curves = rehearse(human, JumpTarget((0.3, 0.0, 0.0), 0.4, 0.3))
    speed = (curves.com[-1] - curves.com[-2]) * 300.0
    assert speed[2] == pytest.approx(curves.plan.path.take_off_velocity[2], rel=0.05)
    assert curves.com[-1][2] == pytest.approx(curves.plan.path.take_off[2], abs=0.02)
    assert demand(human, curves).ratio < 1.0


def test_a_jump_beyond_the_joints_is_refused_with_the_largest_that_fits(human):
    with pytest.raises(InputError, match=r"needs .* N·m .*has .*largest that fits") as told:
        require_feasible(human, JumpTarget((0.0, 0.0, 0.0), 0.7, 0.3))
    airtime = float(str(told.value).split("--airtime ")[1].split()[0])
    assert 0.4 < airtime < 0.55
    require_feasible(human, JumpTarget((0.0, 0.0, 0.0), 0.98 * airtime, 0.3))


def test_servos_are_refused_by_their_speed():
    minibiped = load_robot("minibiped")
    with pytest.raises(InputError, match=r"pitch needs .* rad/s .* fits: --target 0 0 0"):
        require_feasible(minibiped, JumpTarget((0.0, 0.0, 0.0), 0.15, 0.03))


def test_a_servo_that_drives_loses_torque_with_speed_and_one_that_is_driven_does_not():
    minibiped = load_robot("minibiped")
    n = len(minibiped.joints)
    half = np.full((1, n), 2.41)
    driving = available_torque(minibiped, half, np.ones((1, n)))
    driven = available_torque(minibiped, half, -np.ones((1, n)))
    assert driving == pytest.approx(np.full((1, n), 2.05)) and (driven == 4.1).all()
