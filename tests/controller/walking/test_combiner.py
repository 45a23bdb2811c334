"""The combiner of simple controllers: laws, neighbours, partial trajectories."""

import numpy as np
import pytest

from controller.estimation.truth import TruthEstimator
from controller.walking.combiner import Combiner, StyleConfig, share
from controller.walking.gait_styles import GaitStyles
from controller.walking.torque_config import TorqueWalkingConfig
from controller.walking.torque_walker import TorqueWalker
from hil.errors import DescriptionError
from hil.interface import Reference, SensorFrame
from hil.validation import validate
from sim_backends.plant import Plant


def styles(*places):
    return [StyleConfig(speed=speed, water=water) for speed, water in places]


def test_square_law_as_printed_and_the_symmetric_one():
    assert share(0.4, 0.3, 0.7, "square") == pytest.approx(0.0625)
    assert share(0.4, 0.3, 0.7, "symmetric") == pytest.approx(0.1)
    for law in ("square", "symmetric"):
        assert share(0.3, 0.3, 0.7, law) == 0.0
        assert share(0.7, 0.3, 0.7, law) == pytest.approx(1.0)
    # seen from the other side, the symmetric law says the same and the square law does not
    assert 1.0 - share(0.6, 0.3, 0.7, "symmetric") == pytest.approx(
        share(0.4, 0.3, 0.7, "symmetric")
    )
    assert 1.0 - share(0.6, 0.3, 0.7, "square") != pytest.approx(share(0.4, 0.3, 0.7, "square"))


def test_the_two_nearest_speeds_take_part_and_outside_the_nearest_alone():
    combiner = Combiner(styles((0.7, 0.0), (0.3, 0.0), (-0.3, 0.0)), "square")
    assert combiner.parts(0.5, 0.0) == pytest.approx({1: 0.75, 0: 0.25})
    assert combiner.parts(-1.0, 0.0) == {2: 1.0}
    assert combiner.parts(2.0, 0.0) == {0: 1.0}
    assert combiner.parts(0.3, 0.0) == {1: 1.0}


def test_speed_first_and_then_level():
    combiner = Combiner(styles((0.3, 0.0), (0.7, 0.0), (0.3, 0.5), (0.7, 0.5)), "square")
    parts = combiner.parts(0.5, 0.25)
    assert parts == pytest.approx({0: 0.5625, 1: 0.1875, 2: 0.1875, 3: 0.0625})
    assert sum(parts.values()) == pytest.approx(1.0)


def test_levels_may_have_different_speeds():
    combiner = Combiner(styles((0.3, 0.0), (0.7, 0.5), (0.5, 0.5)), "symmetric")
    assert combiner.parts(0.6, 0.25) == pytest.approx({0: 0.5, 1: 0.25, 2: 0.25})


def test_then_over_resistance_and_a_thick_style_changes_nothing_in_water():
    thick = [StyleConfig(speed=0.3, water=water, resistance=5.0) for water in (0.5, 0.75)]
    combiner = Combiner([*thick, *styles((0.3, 0.0), (0.7, 0.0), (0.3, 0.5))], "square")
    without = Combiner(styles((0.3, 0.0), (0.7, 0.0), (0.3, 0.5)), "square")
    shifted = {index + 2: part for index, part in without.parts(0.5, 0.25).items()}
    assert combiner.parts(0.5, 0.25) == shifted
    assert combiner.parts(0.3, 0.75, 5.0) == {1: 1.0}
    parts = combiner.parts(0.3, 0.625, 3.0)
    assert parts == pytest.approx({4: 0.75, 0: 0.1875, 1: 0.0625})


def walking(human, **changes):
    config = {**human.walking, **changes}
    return validate(TorqueWalkingConfig, config, "robot.yaml", "walking")


def test_a_style_changes_only_the_trajectories_that_it_names(human):
    high = [[0.0, 0.7], [1.0, 0.7]]
    config = walking(human, styles=[{"speed": 0.3}, {"speed": 0.7, "poses": {"swing_drop": high}}])
    mixed = GaitStyles(config)
    for speed, part in ((0.2, 0.0), (0.3, 0.0), (0.5, 0.25), (0.7, 1.0)):
        mixed.choose(speed, 0.0)
        for phase in (0.1, 0.5, 0.9):
            standard, now = mixed.standard.at(phase), mixed.curves.at(phase)
            assert now[:-1] == pytest.approx(standard[:-1], abs=1e-12)
            assert now[-1] == pytest.approx((1.0 - part) * standard[-1] + part * 0.7)


def test_without_styles_the_standard_controller_stands(human):
    alone = GaitStyles(walking(human, styles=[]))
    alone.choose(0.7, 1.0)
    assert alone.curves is alone.standard
    assert alone.path is None


def test_on_dry_land_the_shipped_styles_walk_forward_as_the_standard_does(human_config):
    shipped = GaitStyles(human_config)
    for speed in (0.1, 0.3, 0.5, 1.0):
        shipped.choose(speed, 0.0)
        for phase in np.linspace(0.0, 1.05, 40).tolist():
            assert shipped.curves.at(phase) == shipped.standard.at(phase)


def test_a_trajectory_that_does_not_exist_is_refused_by_name(human):
    with pytest.raises(DescriptionError, match="no such trajectory: fin; valid: root_pitch"):
        walking(human, styles=[{"speed": 0.3, "poses": {"fin": [[0.0, 1.0]]}}])
    with pytest.raises(DescriptionError, match="two for the same speed and water level"):
        walking(human, styles=[{"speed": 0.3}, {"speed": 0.3}])


def test_before_the_take_over_the_foot_follows_the_path_of_the_style_from_its_hip(human):
    """And begins there when the pendulum takes it over; the right step mirrors it."""
    path = {"swing_ahead": [[0.0, -0.1], [0.2, -0.02]], "swing_aside": [[0.0, -0.03]]}
    styles_of_path = [{"speed": 0.5, "poses": path}]
    description = human.model_copy(update={"walking": {**human.walking, "styles": styles_of_path}})
    plant = Plant(description, 300, initial_velocity=(0.5, 0.1))
    estimator = TruthEstimator(description, plant.truth)
    walker = TorqueWalker(description, 300, speed=0.5)
    frame = SensorFrame.empty(len(description.joints), imu_present=False)
    followed, sides = 0, set()
    for _ in range(300):
        plant.set_torque(walker.step(estimator.update(frame), Reference(speed=0.5)).torque)
        phase, stance = walker.status.phase, walker.status.stance
        if phase < 0.19:
            hip = walker._robot.hips[1 - stance]
            ahead, aside, _ = walker.status.foot_target - hip
            assert ahead == pytest.approx(-0.1 + 0.08 * phase / 0.2, abs=2e-3)
            assert aside == pytest.approx(-0.03 * (1 - 2 * stance), abs=2e-3)
            followed, sides = followed + 1, sides | {stance}
        plant.step()
    assert followed > 60
    assert sides == {0, 1}
