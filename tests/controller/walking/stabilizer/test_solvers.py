"""Every solver finds torques that put a foot back on its sole, and the model agrees."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller.walking.stabilizer.config import StabilizerConfig
from controller.walking.stabilizer.contact_branch import full_contact_branch
from controller.walking.stabilizer.distribution import distribution
from controller.walking.stabilizer.problem import Problem
from controller.walking.stabilizer.quadratic_program import nearest
from controller.walking.stabilizer.sample_box import SampleBox
from controller.walking.stabilizer.stabilizer import make_solver

SOLVERS = ("cma", "linear", "scan")


@pytest.mark.parametrize("name", SOLVERS)
def test_an_edge_loaded_foot_gets_its_side_back(problem, name):
    assert problem.initial.least < 0.05
    solution = make_solver(name, StabilizerConfig()).solve(problem)
    assert solution.sample is not None
    assert problem.box.clamped(solution.sample) == solution.sample
    assert distribution(problem.response.forces(solution.sample)).least > 0.18


@pytest.mark.parametrize("name", SOLVERS)
def test_nothing_is_accepted_where_nothing_helps(problem, name):
    nothing = SampleBox((-1e-3,) * 3, (1e-3,) * 3)
    stuck = Problem(
        problem.response, problem.evaluation, nothing, problem.initial, True, problem.offset
    )
    solution = make_solver(name, StabilizerConfig()).solve(stuck)
    assert solution.sample is None
    assert solution.limited
    assert stuck.evaluations == {"cma": 25, "linear": 3, "scan": 4}[name]


def test_linear_needs_no_more_samples_than_scan_and_goes_no_further_than_it_must(problem):
    linear = make_solver("linear", StabilizerConfig()).solve(problem)
    spent = problem.evaluations
    make_solver("scan", StabilizerConfig()).solve(problem)
    assert spent <= problem.evaluations - spent
    assert 0.19 < distribution(problem.response.forces(linear.sample)).least < 0.25


def test_cma_can_be_repeated(problem):
    first, second = (make_solver("cma", StabilizerConfig()).solve(problem) for _ in range(2))
    assert first == second


def test_full_contact_branch_is_the_derivative_where_all_corners_carry(problem):
    solution = make_solver("linear", StabilizerConfig()).solve(problem)
    sample, response = np.array(solution.sample), problem.response
    _, branch = full_contact_branch(response)
    base = np.array(response.forces(tuple(sample)))
    for axis in range(2):
        step = np.eye(3)[axis]
        change = np.array(response.forces(tuple(sample + step))) - base
        assert change[:4] == pytest.approx(branch[:4, axis], rel=0.25, abs=0.5)


def test_program_takes_the_shortest_way():
    rows, bounds = np.array([[1.0, 0, 0], [0, 2.0, 0]]), np.array([3.0, -1.0])
    assert nearest(rows, bounds, 1e-9) == pytest.approx((3.0, 0.0, 0.0))
    rows, bounds = np.array([[1.0, 1, 0], [0, 1.0, 0]]), np.array([2.0, 0.5])
    assert nearest(rows, bounds, 1e-9) == pytest.approx((1.0, 1.0, 0.0))


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 10_000))
def test_program_meets_bounds_that_can_be_met_and_no_point_is_nearer(seed):
    rng = np.random.default_rng(seed)
    rows, inside = rng.normal(size=(4, 3)), rng.normal(size=3)
    bounds = rows @ inside - rng.uniform(0.0, 1.0, 4)
    found = np.array(nearest(rows, bounds, 1e-6))
    if np.all(rows @ found >= bounds - 1e-5):  # 20 sweeps are not always enough
        assert np.linalg.norm(found) <= np.linalg.norm(inside) + 1e-3
    else:
        assert np.linalg.norm(np.minimum(rows @ found - bounds, 0.0)) < 1.0
