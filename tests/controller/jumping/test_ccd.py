"""Against a numerical optimum of another kind: damped least squares from many starts."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from jump_robots import ROBOTS, jumper

from controller.jumping.ccd import solve_ccd, sweep
from controller.jumping.chain import leg_chain

TARGETS = 1000
UNREACHABLE = 12
STARTS = 12


def seeds_chain(name):
    """Root to ankle, one point as the seed has it; start; a thousandth of the leg as tolerance."""
    robot = jumper(name)
    chain = leg_chain(robot.model, robot.description, 0)
    chain = replace(chain, tip=chain.anchors[-1:])
    return chain, robot.angles[chain.joints], 1e-3 * robot.model.leg_length


def drawn(chain, rng):
    return rng.uniform(chain.lower, chain.upper)


def nearest(chain, target, rng):
    """Least distance that projected Levenberg-Marquardt steps find from many starts [m]."""
    found = []
    for _ in range(STARTS):
        angles, damping = drawn(chain, rng), 1e-3
        residual = chain.points(angles)[0] - target
        for _ in range(40):
            anchors, axes, tip = chain.placed(angles)
            jacobian = np.cross(axes, tip[0] - anchors).T
            gradient = jacobian.T @ residual
            free = ~(
                ((angles <= chain.lower) & (gradient > 0))
                | ((angles >= chain.upper) & (gradient < 0))
            )
            normal = jacobian[:, free].T @ jacobian[:, free] + damping * np.eye(free.sum())
            step = np.zeros(len(angles))
            step[free] = -np.linalg.solve(normal, gradient[free])
            trial = np.clip(angles + step, chain.lower, chain.upper)
            off = chain.points(trial)[0] - target
            if off @ off < residual @ residual:
                angles, residual, damping = trial, off, 0.3 * damping
            else:
                damping *= 4.0
        found.append(float(np.linalg.norm(residual)))
    return min(found)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_thousand_reachable_targets_converge_within_a_hundred_sweeps(name):
    chain, start, tolerance = seeds_chain(name)
    rng = np.random.default_rng(0)
    sweeps = []
    for _ in range(TARGETS):
        target = chain.points(drawn(chain, rng))
        found = solve_ccd(chain, start, target, tolerance=tolerance)
        assert found.converged
        assert np.linalg.norm(chain.points(found.angles) - target) <= tolerance
        assert (found.angles >= chain.lower).all() and (found.angles <= chain.upper).all()
        sweeps.append(found.sweeps)
    assert max(sweeps) <= 100
    # As few as 30 work well, says the seed.
    assert np.mean(np.array(sweeps) <= 30) > 0.9


@pytest.mark.parametrize("name", ROBOTS)
def test_targets_out_of_reach_end_at_the_least_distance(name):
    chain, start, tolerance = seeds_chain(name)
    rng = np.random.default_rng(1)
    leg = 1e3 * tolerance
    for _ in range(UNREACHABLE):
        direction = rng.normal(size=3)
        target = (
            chain.anchors[0] + direction / np.linalg.norm(direction) * rng.uniform(1.1, 1.6) * leg
        )
        found = solve_ccd(chain, start, target[None], tolerance=tolerance)
        assert not found.converged
        assert (found.angles >= chain.lower).all() and (found.angles <= chain.upper).all()
        assert found.distance <= nearest(chain, target, rng) + tolerance


def test_one_sweep_turns_each_hinge_to_its_own_least_distance():
    """No small turn of the hinge that was turned last, the one at the root, comes nearer."""
    chain, start, _ = seeds_chain("human")
    targets = chain.points(0.5 * (chain.lower + chain.upper))
    angles, distance = sweep(chain, start, targets)
    assert distance == pytest.approx(np.linalg.norm(chain.points(angles) - targets))
    for turn in (-1e-3, 1e-3):
        other = angles.copy()
        other[0] += turn
        if chain.lower[0] <= other[0] <= chain.upper[0]:
            assert np.linalg.norm(chain.points(other) - targets) >= distance


@pytest.mark.parametrize("name", ROBOTS)
def test_the_chain_is_the_leg_of_the_model(name):
    robot = jumper(name)
    for foot in (0, 1):
        chain = leg_chain(robot.model, robot.description, foot)
        angles = robot.angles
        angles[chain.joints] = drawn(chain, np.random.default_rng(foot))
        posture = robot.start
        posture.joint_position = angles
        robot.model.set_state(posture)
        joints = robot.model.joint_ids[chain.joints]
        anchors, axes, tip = chain.placed(angles[chain.joints])
        assert anchors + posture.base_position == pytest.approx(robot.model.data.xanchor[joints])
        assert axes == pytest.approx(robot.model.data.xaxis[joints])
        # The points of the tip keep their places in the foot.
        sole = robot.model.foot_rotations[foot]
        local = (tip + posture.base_position - robot.model.ankle_positions[foot]) @ sole
        gaps = [np.linalg.norm(a - b) for a, b in itertools.combinations(local, 2)]
        assert min(gaps) > 0.4 * robot.model.leg_length
        assert local[:, 2] == pytest.approx(0.0, abs=1e-9)
