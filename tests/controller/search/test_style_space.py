"""The variables of a gait style: how many, where they start, what they become."""

import numpy as np
import pytest

from controller.search.style_space import WAY_KNOTS, StyleSpace, reference_acceleration
from controller.walking.gait_styles import GaitStyles
from controller.walking.torque_config import torque_walking_config
from hil.robot_files import load_robot

WAY = {name: 0.1 * np.array(phases) for name, phases in WAY_KNOTS.items()}
FALLING = "walking.take_over.rule=falling"


def test_the_seed_counts_51_variables():
    space = StyleSpace(load_robot("human", (FALLING,)), 0.7, 0.5, WAY)
    assert len(space.variables) == 51
    counts = [sum(one.keys[0] == name for one in space.variables) for name in
              ("root_pitch", "back_pitch", "stance_foot", "swing_foot", "stance_knee",
               "swing_aside", "swing_drop", "swing_ahead")]  # fmt: skip
    assert counts == [3, 2, 11, 11, 5, 3, 5, 11]


def test_key_points_that_cannot_act_are_no_variables():
    """The pendulum takes the foot at phase 0.2: the curve up to there needs the points to 0.3."""
    space = StyleSpace(load_robot("human"), 0.7, 0.5, WAY)
    ahead = [one for one in space.variables if one.keys[0] == "swing_ahead"]
    assert len(ahead) == 4
    assert len(space.style((0.0,) * len(space.variables))["poses"]["swing_ahead"]) == 11


def test_it_starts_from_what_the_combiner_makes_of_the_present_styles():
    human = load_robot("human")
    space = StyleSpace(human, 0.7, 0.5, WAY)
    still = space.style((0.0,) * len(space.variables))
    assert dict(map(tuple, still["poses"]["swing_drop"]))[0.5] == pytest.approx(0.6)
    between = StyleSpace(human, 0.35, 0.5, WAY)
    lifted = dict(map(tuple, between.style((0.0,) * len(between.variables))["poses"]["swing_drop"]))
    assert 0.6 < lifted[0.5] < 0.83


def test_a_vector_becomes_a_style_that_walks_at_its_cell_alone():
    human = load_robot("human")
    space = StyleSpace(human, 0.7, 0.5, WAY)
    vector = [0.0] * len(space.variables)
    place = [one.name for one in space.variables].index("swing_drop[2]")
    vector[place] = 2.0
    styles = space.values(vector)["walking.styles"]
    of_water = [one for one in styles if one.get("resistance", 1) == 1]
    knee_deep = [one["speed"] for one in of_water if one.get("water") == 0.5]
    assert knee_deep == [0.3, 0.4, 0.7], "the robot's own, and one in place of that at 0.7 m/s"
    changed = load_robot("human", (f"walking.styles={styles!r}",))
    found = GaitStyles(torque_walking_config(changed))
    found.choose(0.7, 0.5)
    assert found.curves.at(0.5)[-1] == pytest.approx(0.6 + 2.0 * 0.04, abs=1e-3)
    assert found.path.at(0.2)[0] == pytest.approx(0.02, abs=1e-3)


def test_rougher_reference_poses_accelerate_more():
    human = load_robot("human")
    rough = load_robot(
        "human", ("walking.key_poses.root_pitch=[[0.02,0.5],[0.5,-0.5],[0.98,0.5]]",)
    )
    calm = reference_acceleration(human, 0.5, 0.0)
    assert 0.0 < calm < reference_acceleration(rough, 0.5, 0.0)
