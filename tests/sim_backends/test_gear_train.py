"""Backlash: a gap between motor and joint that every reversal has to cross."""

from functools import partial

import numpy as np
import pytest

from sim_backends.gear_train import ROTOR
from tests.sim_backends.conftest import run

GAP = 0.0175
KNEE = 3


@pytest.fixture
def floating(in_the_air):
    """Held in the air without gravity: only motors and gears move the joints."""

    return partial(in_the_air, settle_s=0.3)


def rotor_angle(plant, joint="left_knee"):
    return float(plant.data.joint(joint + ROTOR).qpos[0])


def test_a_reversal_loses_the_gap(floating):
    """Pushed one way and then the other way by hand, the joint moves a gap before the motor."""
    plant = floating(f"backlash={GAP}")
    ends = []
    for torque in (0.3, -0.3):
        plant.data.qfrc_applied[6 + KNEE] = torque
        run(plant, 0.8)
        ends.append(float(plant.joint_position[KNEE]) - rotor_angle(plant))
    assert ends[0] - ends[1] == pytest.approx(GAP, rel=0.05)


def test_without_torque_the_joint_is_free_inside_the_gap_only(floating):
    """A hand that is weaker than the gear's friction can move the joint by the gap."""
    rigid, slack = floating("joint_friction=0.2"), floating("joint_friction=0.2", f"backlash={GAP}")
    travel = []
    for plant in (rigid, slack):
        for servo in range(12):
            plant.servos.set_enabled(servo, False)
        ends = []
        for torque in (0.05, -0.05):
            plant.data.qfrc_applied[6 + KNEE] = torque
            run(plant, 0.5)
            ends.append(float(plant.joint_position[KNEE]))
        travel.append(ends[0] - ends[1])
    assert abs(travel[0]) < 0.002
    assert travel[1] == pytest.approx(GAP, rel=0.1)


def test_the_encoder_is_on_the_joints_side(floating):
    plant = floating(f"backlash={GAP}")
    before, rotor = plant.servos.counts[KNEE], rotor_angle(plant)
    plant.data.joint("left_knee").qpos[0] += 0.4 * GAP
    plant.substep()
    moved = plant.servos.counts[KNEE] - before
    assert moved == pytest.approx(0.4 * GAP * 4096 / (2 * np.pi), abs=2.5)
    assert rotor_angle(plant) == pytest.approx(rotor, abs=1e-3)


def test_outside_the_gap_the_motor_moves_the_joint_as_without_it(floating):
    """The same rotor inertia, whether it is in the joint or behind the gap."""
    ends = []
    for gap in (0.0, 1e-3):
        plant = floating(f"backlash={gap}")
        plant.servos.goal[KNEE] += 300
        run(plant, 0.1)
        ends.append(float(plant.joint_position[KNEE]))
    assert ends[1] == pytest.approx(ends[0], abs=0.01)


def test_a_loop_around_the_gap_hunts(floating):
    """With the encoder behind the gap a stiff gain keeps the joint from coming to rest."""
    motion = []
    for gap in (0.0, GAP):
        plant = floating(f"backlash={gap}", "joint_friction=0.03", "armature=0.03")
        plant.servos.goal[KNEE] += 100
        run(plant, 1.0)
        angles = []
        for _ in range(300):
            plant.step()
            angles.append(float(plant.joint_position[KNEE]))
        motion.append(np.ptp(angles))
    assert motion[0] < 1e-3
    assert motion[1] > 2 * motion[0]
