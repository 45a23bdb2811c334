"""A stance of the human in which one edge of the flat foot carries nothing."""

from copy import deepcopy
from types import SimpleNamespace

import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.distribution import distribution
from controller.walking.stabilizer.evaluation import Evaluation
from controller.walking.stabilizer.problem import Problem
from controller.walking.stabilizer.reduced_models import build
from controller.walking.stabilizer.response import ResponseModel
from controller.walking.stabilizer.sample_box import sample_box

from ..conftest import HumanWalk

GUARDED = ("walking.ankle_guards=true",)
RATE = 300
FLAT = 0.0175
"""Tilt [rad] to which a sole counts as on the floor, 1 degree: the far corners of one that rolled
further are off it, and no torque of one tick brings them back."""


@pytest.fixture(scope="session")
def edge_loaded():
    """True state, torques and stance of the first such tick of a walk without ankle limit."""
    human = HumanWalk(RATE, ankle_limit=False, overrides=GUARDED)
    for _ in range(900):
        estimate = deepcopy(human.tick())
        torques = human.walker._command.torque.copy()
        status = human.walker.status
        forces = human.plant.truth().foot_force[status.stance]
        now = distribution([*forces, 0.0])
        rolled = min(now.left, now.right) < 0.05 and now.total > 400.0
        robot = human.walker._robot
        tilt = np.hypot(*robot.feet[status.stance][2, :2])
        if status.foot_flat and 0.15 < status.phase < 0.4 and rolled and tilt < FLAT:
            return SimpleNamespace(
                description=human.description,
                estimate=estimate,
                torques=torques,
                stance=status.stance,
                forces=[*forces, human.plant.truth().toe_force[status.stance]],
            )
    raise AssertionError("the walk never rolled on an edge")


@pytest.fixture
def response(edge_loaded):
    """The whole model, placed in that stance."""
    robot = RobotModel(edge_loaded.description)
    robot.set_state(edge_loaded.estimate)
    whole = build(edge_loaded.description, robot, (), 1)
    model = ResponseModel(robot, edge_loaded.description, whole, 1 / RATE)
    model.place(edge_loaded.torques, edge_loaded.stance)
    return model


@pytest.fixture
def problem(edge_loaded, response):
    """The search that this stance asks for."""
    config = StabilizerConfig()
    robot = RobotModel(edge_loaded.description)
    initial = distribution(response.place(edge_loaded.torques, edge_loaded.stance))
    room = ((-100.0, -100.0, -200.0), (100.0, 100.0, 200.0))
    box = sample_box(config, robot.weight * robot.leg_length, initial, True, room)
    evaluation = Evaluation(config.band, config.load * robot.weight)
    return Problem(response, evaluation, box, initial, True, list(np.zeros(5)))
