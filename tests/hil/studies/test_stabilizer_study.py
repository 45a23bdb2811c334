"""The stabilizer study on a few steps of the human."""

import pytest

from hil.request import RunRequest
from hil.studies.stabilizer import StabilizerCase, Variant, variant_request, walk_variant

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
