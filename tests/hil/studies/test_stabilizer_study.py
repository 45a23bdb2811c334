"""The stabilizer study on a few steps of the human."""

import numpy as np
import pytest

from controller.estimation.sensors import empty_estimate
from hil.interface import SensorFrame
from hil.request import RunRequest
from hil.studies.noisy_loads import NoisyLoads
from hil.studies.stabilizer import StabilizerStudy
from hil.studies.stabilizer_walks import (
    StabilizerCase,
    Variant,
    lateral_pushes,
    variant_request,
    walk_variant,
)

HUMAN = RunRequest(
    robot="human", backend="mujoco", rate_hz=300, estimator="truth", pd="explicit",
    stabilizer=False, ankle_limit=True, overrides=("plant.floor_friction=0.9",),
)  # fmt: skip


def case(variant, **values):
    return StabilizerCase(
        request=HUMAN, variant=variant, steps=4, step_s=0.48, amplitude=0.2, **values
    )


def test_models_are_worse_the_more_they_leave_out():
    result = walk_variant(case(Variant(ankle="limit"), compare_models=True))
    errors = {name: figures["model_error_pct"] for name, figures in result["models"].items()}
    assert errors["M0"] == 0.0
    assert 0.0 < errors["M1"] < errors["M2"] < errors["M3"] < 20.0
    assert min(errors["M4"], errors["M5"]) > errors["M2"]
    assert errors["M6"] <= max(errors["M3"], errors["M4"])


@pytest.mark.parametrize("solver", ["cma", "linear", "scan"])
def test_a_stabilizer_walks_and_counts_what_it_does(solver):
    result = walk_variant(case(Variant(solver=solver, model="M2", ankle="limit")))
    assert result["stopped_s"] is None and result["steps"] >= 3
    assert result["iterations"] > 0.0
    assert 0.0 <= result["disequilibrium_pct"] <= 100.0


def test_a_variant_is_what_the_walk_is_asked_for():
    asked = variant_request(HUMAN, Variant(solver="scan", model="M5", ankle="guards"))
    assert (asked.stabilizer, asked.stabilizer_solver, asked.ankle_limit) == (True, "scan", False)
    assert asked.overrides == (
        *HUMAN.overrides,
        "walking.ankle_guards=true",
        "walking.stabilizer.model=M5",
    )
    assert variant_request(HUMAN, Variant(ankle="limit")) == HUMAN


def test_time_is_told_as_multiples_of_a_physics_step_and_pushes_by_rate():
    """Made-up walks: a step of the physics takes 0.05 ms, the controller 0.2 or 0.3 ms."""

    def run_cases(function, cases):
        return [made_up(function.__name__, case) for case in cases]

    def made_up(name, case):
        if name == "time_steps":
            return {"step_s": 0.5}
        if name == "walk_pushed":
            return {"limit_pct": float(case.rate_hz), "stopped_s": None}
        ms = 0.2 if case.variant.solver is None else 0.3
        return {"controller_ms": ms, "mj_step_ms": 0.05, "stopped_s": None, "models": {}}

    study = StabilizerStudy(
        request=HUMAN, steps=10, solvers=("linear",), models=(), model_solver="cma",
        ankles=("limit",), probe_s=3.0, push_rates=(300, 225),
    )  # fmt: skip
    result = study.conduct(run_cases)
    base, linear, *pushed = result.rows
    assert base["controller_steps"] == pytest.approx(4.0)
    assert linear["stabilizer_steps"] == pytest.approx(2.0)
    assert [row["limit_pct"] for row in pushed] == [300.0, 225.0]
    assert len(result.tables) == 2


def test_pushes_come_from_both_sides_and_end_before_the_walk():
    pushes = lateral_pushes(100.0, 12.0)
    assert [push.force[1] for push in pushes] == [100.0, -100.0]
    assert all(push.start + push.duration <= 12.0 for push in pushes)


def test_noise_is_on_the_corners_alone_and_as_large_as_asked_for():
    class Still:
        def update(self, frame):
            return empty_estimate(3)

    noisy = NoisyLoads(Still(), 5.0, seed=1)
    found = [noisy.update(SensorFrame.empty(3)) for _ in range(500)]
    forces = np.array([estimate.foot_force for estimate in found])
    assert forces.std() == pytest.approx(5.0, rel=0.05)
    assert abs(forces.mean()) < 0.3
    assert not any(estimate.toe_force.any() for estimate in found)
