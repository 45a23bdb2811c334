import math

import numpy as np
import pytest
from jump_robots import ROBOTS, jumper

from controller.jumping.muscle_laws import CHORD, LAWS, MITRE
from controller.jumping.muscles import Muscles
from hil.errors import InputError


@pytest.mark.parametrize(("ratio", "degrees"), [(1.0, 0.0), (1.2, 67.1), (1.5, 96.4), (2.0, 120.0)])
def test_the_printed_law_at_the_boundary_and_above(ratio, degrees):
    """θ = acos(2k²r²/F² − 1): a straight joint at F = k·r."""
    assert math.degrees(MITRE.bend(ratio * 300.0 * 0.05, 300.0, 0.05)) == pytest.approx(
        degrees, abs=0.1
    )


def test_below_the_boundary_the_printed_law_has_no_bend():
    with pytest.raises(InputError, match="below k·r = 15 N"):
        MITRE.bend(14.999, 300.0, 0.05)


def test_the_chord_law_is_the_length_of_a_spring_between_two_bones():
    """Both ends at r from the joint; slack when straight, k·r at 60°, no more than 2·k·r."""
    stiffness, width = 400.0, 0.04
    for bend in np.linspace(0.0, 3.0, 7):
        first = width * np.array((1.0, 0.0))
        second = width * np.array((math.cos(bend), math.sin(bend)))
        length = float(np.linalg.norm(first - second))
        assert CHORD.force(bend, stiffness, width) == pytest.approx(stiffness * length)
    assert CHORD.bend(stiffness * width, stiffness, width) == pytest.approx(math.pi / 3)
    with pytest.raises(InputError, match="outside"):
        CHORD.bend(2.001 * stiffness * width, stiffness, width)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_bend_force_and_slope_belong_together(law):
    for bend in np.linspace(0.1, 2.6, 9):
        force = law.force(bend, 250.0, 0.05)
        assert law.bend(force, 250.0, 0.05) == pytest.approx(bend)
        rise = law.force(bend + 1e-6, 250.0, 0.05) - law.force(bend - 1e-6, 250.0, 0.05)
        assert law.slope(bend, 250.0, 0.05) == pytest.approx(rise / 2e-6, rel=1e-6)


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_the_legs_of_a_robot(name, law):
    robot = jumper(name)
    muscles = Muscles.of(robot.model, robot.description, law)
    angles = robot.angles
    for bend in (0.5, 1.5):
        angles[list(muscles.joints)] = muscles.straight + bend
        force = muscles.force(angles)
        assert muscles.bend(force) == pytest.approx(bend)
        # The reach is that of the real leg, and the stiffening the slope of force over drop.
        robot.model.set_state(robot.start)
        assert muscles.bend_at(muscles.reach(bend)) == pytest.approx(bend)
        drop = muscles.reach(bend) - muscles.reach(bend + 1e-6)
        angles[list(muscles.joints)] += 1e-6
        rise = muscles.force(angles) - force
        assert muscles.stiffening(bend) == pytest.approx(rise / drop, rel=1e-4)
        matched = muscles.matched(2.0 * force, bend)
        assert matched.bend(2.0 * force) == pytest.approx(bend)


@pytest.mark.parametrize("name", ROBOTS)
def test_both_laws_agree_at_the_two_bends_that_their_strength_is_chosen_for(name):
    robot = jumper(name)
    mitre, chord = (Muscles.of(robot.model, robot.description, law) for law in (MITRE, CHORD))
    for ratio in (math.cos(math.radians(20.9)), math.cos(math.radians(69.1))):
        force = robot.model.weight / ratio
        assert chord.bend(force) == pytest.approx(mitre.bend(force), abs=0.01)
    assert mitre.bend(robot.model.weight) == pytest.approx(0.0, abs=1e-6)


def test_muscles_without_strength_are_refused():
    robot = jumper("human")
    with pytest.raises(InputError, match="above 0"):
        Muscles.of(robot.model, robot.description, MITRE, stiffness=0.0)
