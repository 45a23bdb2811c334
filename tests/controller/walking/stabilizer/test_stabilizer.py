"""The stabilizer in the walk: quiet on a flat foot, missed on a rolling one."""

import json

import numpy as np
import pytest

from controller.robot_model import RobotModel
from controller.walking.ankle_guards import AnkleGuards
from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.distribution import distribution
from controller.walking.stabilizer.sample_box import NO_TORQUE
from controller.walking.stabilizer.stabilizer import Stabilizer
from controller.walking.torque_walker import TorqueWalker
from hil.compose import build
from hil.errors import InputError
from hil.request import RunRequest
from hil.run import run

from ..conftest import HumanWalk
from .conftest import GUARDED, RATE


def stabilized(pd="explicit", solver="linear", limit=False, stabilizer=True):
    human = HumanWalk(RATE, pd, ankle_limit=limit, overrides=() if limit else GUARDED)
    human.walker = TorqueWalker(human.description, RATE, pd, limit, 0.5, stabilizer, solver)
    return human


def disequilibrium(human, seconds):
    """Share of loaded ticks after foot-flat in which a side carries less than 15 %."""
    poor = []
    human.walk(2.0)  # a start on the edge of the foot is no matter of the stabilizer
    for _ in range(round(seconds * RATE)):
        human.tick()
        status, truth = human.walker.status, human.plant.truth()
        forces = [*truth.foot_force[status.stance], truth.toe_force[status.stance]]
        now = distribution(forces)
        if status.foot_flat and now.total > 100.0:
            poor.append(now.least < 0.15)
        human.reference.lateral = 0.2 if human.steps % 10 >= 5 else -0.2
    return np.mean(poor)


def test_without_stabilizer_and_limit_the_foot_rolls():
    assert disequilibrium(stabilized(stabilizer=False), 4.0) > 0.3


@pytest.mark.parametrize(("pd", "solver"), [("explicit", "linear"), ("implicit", "scan")])
def test_stabilizer_keeps_the_foot_on_its_sole(pd, solver):
    human = stabilized(pd, solver)
    assert disequilibrium(human, 4.0) < 0.05
    counts = human.walker._stabilizer.statistics
    assert counts.accepted > 0.8 * counts.triggered > 0


def test_with_the_limit_too_almost_nothing_is_left():
    assert disequilibrium(stabilized(limit=True), 4.0) < 0.005


def make(edge_loaded, **config):
    robot = RobotModel(edge_loaded.description)
    robot.set_state(edge_loaded.estimate)
    description = edge_loaded.description
    return Stabilizer(StabilizerConfig(**config), "linear", description, robot, RATE)


def test_torques_go_to_the_stance_leg_alone(edge_loaded):
    torques = edge_loaded.torques.copy()
    measured = list(edge_loaded.forces)
    stabilizer = make(edge_loaded)
    extra = stabilizer.add_torques(torques, edge_loaded.stance, True, measured, False)
    changed = np.flatnonzero(torques != edge_loaded.torques)
    side = ("left", "right")[edge_loaded.stance]
    names = [edge_loaded.description.joint_names[j] for j in changed]
    assert set(names) <= {f"{side}_{j}" for j in ("ankle_pitch", "ankle_roll", "knee")}
    assert extra != NO_TORQUE


def test_a_well_loaded_foot_is_left_alone(edge_loaded):
    torques = edge_loaded.torques.copy()
    stabilizer = make(edge_loaded)
    even = [150.0, 150.0, 150.0, 150.0, 20.0]
    extra = stabilizer.add_torques(torques, edge_loaded.stance, True, even, False)
    assert extra == NO_TORQUE and np.array_equal(torques, edge_loaded.torques)
    assert stabilizer.solution.iterations == 0


def test_load_cells_outweigh_the_model(edge_loaded):
    """Cells that keep showing a good foot stop the search that the model alone would begin."""
    stabilizer = make(edge_loaded, calm=0.55)
    even = [150.0, 150.0, 150.0, 150.0, 20.0]
    found = []
    for _ in range(40):
        torques = edge_loaded.torques.copy()
        found.append(
            stabilizer.add_torques(torques, edge_loaded.stance, True, even, False) != NO_TORQUE
        )
    assert found[0] and not found[-1]


def test_guards_let_through_what_the_contact_allows(human):
    robot = RobotModel(human)
    guards, heading = AnkleGuards(robot), np.eye(3)
    torque = np.array([50.0, 10.0, 5.0])
    assert guards.guarded(torque, 0, 100.0, 0.5, heading) == pytest.approx(
        [20.1, 10.0, 0.0], abs=0.2
    )
    assert not guards.guarded(torque, 0, 0.0, 0.5, heading).any()
    assert guards.guarded(torque, 0, 100.0, 0.1, heading)[1] == 0.0
    robot.foot_twists[0][:3] = (1.0, 0.0, 0.0)
    assert guards.guarded(torque, 0, 100.0, 0.5, heading)[0] == 0.0
    assert guards.guarded(-torque, 0, 100.0, 0.5, heading)[0] < 0.0


def test_a_run_reports_what_the_stabilizer_did(tmp_path):
    request = RunRequest.checked(
        robot="human", duration_s=3.0, stabilizer=True, stabilizer_solver="scan",
        ankle_limit=False, overrides=GUARDED, out=tmp_path / "run",
    )  # fmt: skip
    run(build(request), progress=False)
    report = json.loads((tmp_path / "run" / "report.json").read_text())
    assert report["stabilizer"] is True
    assert report["stabilizer_iterations_mean"] > 0.3
    assert 0.0 < report["stabilizer_limit_pct"] < 30.0


def test_a_solver_needs_a_stabilizer_and_the_stabilizer_torques(human):
    with pytest.raises(InputError, match="--stabilizer-solver needs --stabilizer"):
        RunRequest.checked(robot="human", stabilizer_solver="cma").resolved(human)
    request = RunRequest.checked(robot="minibiped", stabilizer=True)
    with pytest.raises(InputError, match="has servos"):
        build(request)
