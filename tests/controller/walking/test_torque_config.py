"""Which gain set a rate gets, and what a walking section must hold."""

import pytest

from controller.walking.torque_config import TorqueWalkingConfig, torque_walking_config
from hil.errors import DescriptionError
from hil.validation import validate


@pytest.mark.parametrize(
    ("rate", "published"), [(120, 225), (225, 225), (299, 225), (300, 300), (2000, 300)]
)
def test_explicit_pd_takes_the_set_of_the_next_rate_below(human_config, rate, published):
    assert human_config.gains_at(rate, implicit=False) == human_config.gains[published]


def test_implicit_pd_takes_one_set_at_every_rate(human_config):
    for rate in (60, 225, 1000):
        assert human_config.gains_at(rate, implicit=True) == human_config.gains[300]


def test_a_chosen_set_is_used_whatever_the_rate(human_config):
    config = human_config.model_copy(update={"gain_rate": 750})
    assert config.gains_at(225, implicit=False) == config.gains[750]
    assert config.gains_at(225, implicit=True) == config.gains[750]


def test_published_gain_sums(human_config):
    """ΣKp + 10·ΣKd over all joints, left and right counted, of the author's files."""
    single = ("root", "back", "neck")
    for rate, total in ((225, 5350), (250, 7460), (300, 7760), (500, 8960), (750, 8990),
                        (1000, 16030), (2000, 24180)):  # fmt: skip
        gains = human_config.gains[rate]
        weight = {joint: 1 if joint in single else 2 for joint in gains}
        assert sum(weight[j] * (kp + 10 * kd) for j, (kp, kd) in gains.items()) == pytest.approx(
            total, abs=10
        )


def test_gain_set_without_a_joint_is_refused(human):
    gains = {rate: dict(table) for rate, table in human.walking["gains"].items()}
    del gains[300]["knee"]
    with pytest.raises(DescriptionError, match=r"gains\.300: joints missing or unknown: knee"):
        validate(TorqueWalkingConfig, {**human.walking, "gains": gains}, "human.yaml", "walking")


def test_references_stand_in_for_the_styles_of_their_cells(human):
    """One at a style's own speed and level, one at a speed of its own."""
    references = [{"speed": 0.3, "water": 0.5}, {"speed": 0.9, "water": 0.5}]
    told = human.model_copy(
        update={"walking": human.walking | {"references": references, "use_references": False}}
    )
    without = torque_walking_config(told)
    assert without.chosen_styles == without.styles
    walking = told.walking | {"use_references": True}
    chosen = torque_walking_config(told.model_copy(update={"walking": walking})).chosen_styles
    assert len(chosen) == len(without.styles) + 1
    assert [one.speed for one in chosen[-2:]] == [0.3, 0.9]


def test_two_references_for_one_cell_are_refused(human):
    twice = human.walking | {"references": [{"speed": 0.3, "water": 0.5}] * 2}
    with pytest.raises(DescriptionError, match="references: two for the same speed"):
        torque_walking_config(human.model_copy(update={"walking": twice}))
