import numpy as np
import pytest
from jump_robots import ROBOTS, jumper

from controller.jumping.muscle_laws import CHORD, LAWS
from controller.jumping.muscles import Muscles
from controller.jumping.path import JumpTarget, estimate_path
from controller.jumping.windup import WindupSettings, wind_up
from hil.errors import InputError

MOON = 1.62


def wound(name, force, law=CHORD, muscles=None, **settings):
    robot = jumper(name)
    muscles = muscles or Muscles.of(robot.model, robot.description, law)
    settings = WindupSettings(**settings)
    return wind_up(robot.model, robot.description, robot.start, force, muscles, settings)


def knee_range(name, law):
    """Forces of the legs from the start's bend, or a tenth of a radian, to the knees' limit [N]."""
    robot = jumper(name)
    muscles = Muscles.of(robot.model, robot.description, law)
    knee = robot.description.joints[muscles.joints[0]]
    bent = np.zeros(len(robot.angles))
    forces = []
    for angle in (muscles.straight + 0.1, knee.range[1]):
        bent[list(muscles.joints)] = angle
        forces.append(muscles.force(bent))
    return forces


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_every_feasible_force_is_reached_in_balance_on_fixed_feet(name, law):
    robot = jumper(name)
    least, most = knee_range(name, law)
    robot.model.set_state(robot.start)
    feet = robot.model.corner_positions
    for share in (0.0, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 1.0):
        windup = wound(name, least + share * (most - least), law)
        assert windup.converged, (share, windup.blocked_by)
        assert windup.least_margin > 0.0
        limits = np.array([joint.range for joint in robot.description.joints])
        for frame in windup.frames:
            angles = frame.posture.joint_position
            assert (angles >= limits[:, 0] - 1e-9).all() and (angles <= limits[:, 1] + 1e-9).all()
            robot.model.set_state(frame.posture)
            slip = np.abs(robot.model.corner_positions - feet).max()
            assert slip < 1e-4 * robot.model.leg_length
        last = windup.frames[-1]
        assert np.linalg.norm(last.balance_error) < 0.002 * robot.model.leg_length
        assert last.force == pytest.approx(windup.wanted_force, rel=0.01)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_force_beyond_the_knees_limit_ends_there_and_says_so(name):
    _, most = knee_range(name, CHORD)
    windup = wound(name, most * 1.03)
    assert not windup.converged
    assert {"left_knee", "right_knee"} <= set(windup.blocked_by)
    assert windup.least_margin > 0.0


def jump_force(name, gravity=9.81, mass_scale=1.0):
    """The same target and air time everywhere, as an animator would set them."""
    robot = jumper(name).model
    leg = robot.leg_length
    target = JumpTarget((0.3 * leg, 0, 0), 0.31 * leg**0.5, 0.35 * leg, gravity)
    return float(np.linalg.norm(estimate_path(target, mass_scale * robot.mass).force))


@pytest.mark.parametrize("name", ROBOTS)
def test_the_moon_asks_for_less_windup_and_double_mass_for_more(name):
    earth, moon, heavy = (
        wound(name, force)
        for force in (jump_force(name), jump_force(name, MOON), jump_force(name, mass_scale=2.0))
    )
    assert earth.converged and moon.converged and heavy.converged
    assert heavy.wanted_force == pytest.approx(2.0 * earth.wanted_force)
    assert moon.wanted_force < 0.3 * earth.wanted_force
    leg = jumper(name).model.leg_length
    assert moon.depth < earth.depth - 0.05 * leg
    assert earth.depth < heavy.depth - 0.1 * leg


def test_stiffer_or_wider_muscles_need_less_bend():
    robot = jumper("human")
    plain = Muscles.of(robot.model, robot.description, CHORD)
    force = jump_force("human")
    k, r = plain.stiffness, plain.width
    depths = [
        wound(
            "human", force, muscles=Muscles.of(robot.model, robot.description, CHORD, *pair)
        ).depth
        for pair in ((k, r), (1.5 * k, r), (k, 1.5 * r))
    ]
    assert depths[1] < 0.7 * depths[0]
    # Only k·r counts.
    assert depths[2] == pytest.approx(depths[1], abs=1e-3)


def test_gains_too_small_creep_and_too_large_never_settle():
    force = jump_force("human")
    sweet, slow, wild = (
        wound("human", force, kp=kp, kd=0.0, travel=1.0, iterations=60) for kp in (0.5, 0.08, 2.4)
    )
    assert sweet.converged and slow.converged
    assert len(slow.frames) > 3 * len(sweet.frames)
    assert not wild.converged


def test_a_force_that_no_bend_gives_is_refused():
    _, most = knee_range("human", CHORD)
    with pytest.raises(InputError, match="outside"):
        wound("human", 2.0 * most)
    with pytest.raises(InputError, match="kp"):
        wound("human", most, kp=0.0)
