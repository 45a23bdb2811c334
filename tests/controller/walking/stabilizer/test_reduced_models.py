"""Reduced models weigh what the robot weighs, where it weighs it."""

import mujoco
import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.stabilizer.model_choice import HELD_TICKS, ModelChoice
from controller.walking.stabilizer.model_comparison import ModelComparison
from controller.walking.stabilizer.reduced_models import PARTS, build
from controller.walking.stabilizer.response import ResponseModel
from hil.robot_files import load_robot

from ..conftest import random_state


def body_names(model):
    return {mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, b) for b in range(1, model.nbody)}


ARMS = {f"{side}_{part}" for side in ("left", "right") for part in ("upper_arm", "forearm")}
LEFT_LEG = {f"left_{part}" for part in ("thigh", "shank", "foot", "toes")}


@pytest.mark.parametrize(
    ("name", "missing"),
    [
        ("M0", set()),
        ("M1", ARMS),
        ("M2", ARMS | {"head"}),
        ("M3", ARMS | {"head", "torso"}),
        ("M4", ARMS | {"head", "torso"} | LEFT_LEG),
        ("M5", ARMS | {"head"} | LEFT_LEG),
    ],
)
def test_models_lack_what_the_seed_says(human, name, missing):
    robot = RobotModel(human)
    reduced = build(human, robot, PARTS[name], swing=0)
    assert body_names(robot.model) - body_names(reduced.model) == missing


@pytest.mark.parametrize("robot_name", ["human", "minibiped"])
@pytest.mark.parametrize("name", list(PARTS))
@pytest.mark.parametrize("swing", [0, 1])
def test_weight_and_its_moment_are_kept(robot_name, name, swing):
    description = load_robot(robot_name)
    robot = RobotModel(description)
    robot.set_state(random_state(description, seed=5, speed=0.0))
    reduced = build(description, robot, PARTS[name], swing)
    response = ResponseModel(robot, description, reduced, 1 / 300)
    response.place(np.zeros(len(description.joints)), 1 - swing)
    model, data = response.model, response.data
    own = model.body_mass[:, None] * model.opt.gravity
    force, torque = data.xfrc_applied[:, :3], data.xfrc_applied[:, 3:]
    assert (own + force).sum(axis=0) == pytest.approx([0, 0, -robot.weight])
    moment = (np.cross(data.xipos, own + force) + torque).sum(axis=0)
    whole = np.cross(robot.com, [0, 0, -robot.weight])
    assert moment == pytest.approx(whole, abs=1e-6 * robot.weight)


def test_whole_model_predicts_the_next_step_exactly(edge_loaded, response):
    forces = response.place(edge_loaded.torques, edge_loaded.stance)
    assert forces == pytest.approx(edge_loaded.forces, rel=1e-4, abs=0.01)


def test_what_was_asked_before_does_not_change_the_answer(edge_loaded, response):
    """The solver starts from the last sample's solution, and only saves iterations by it."""
    fresh = response.place(edge_loaded.torques, edge_loaded.stance)
    sample = response.forces((5.0, -3.0, 10.0))
    for other in ((80.0, -60.0, 200.0), (-80.0, 60.0, -200.0)):
        response.forces(other)
    assert response.forces((5.0, -3.0, 10.0)) == pytest.approx(sample, abs=1e-3)
    response.place(np.zeros_like(edge_loaded.torques), 1 - edge_loaded.stance)
    again = response.place(edge_loaded.torques, edge_loaded.stance)
    assert again == pytest.approx(fresh, abs=1e-3)


def test_comparison_ranks_the_models(edge_loaded):
    comparison = ModelComparison(edge_loaded.description, 300)
    comparison.add(edge_loaded.estimate, edge_loaded.torques, edge_loaded.stance, False)
    shares = comparison.errors / comparison.load
    errors = dict(zip(comparison.names, 100.0 * shares, strict=True))
    assert errors["M0"] == 0.0
    assert 0.0 < errors["M2"] < 5.0
    assert errors["M2"] < errors["M4"]


def test_m6_keeps_both_legs_for_a_while_after_contact(human):
    choice = ModelChoice("M6", human, RobotModel(human), 1 / 300)
    single = choice.choose(0, swing_contact=False)
    assert single.model.nbody < choice.choose(0, swing_contact=True).model.nbody
    legs = [choice.choose(0, swing_contact=False).model.nbody for _ in range(HELD_TICKS)]
    assert legs == [legs[0]] * (HELD_TICKS - 1) + [single.model.nbody]
