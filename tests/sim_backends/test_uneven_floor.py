"""The uneven floor: feelers feel what the sole felt, and its heights where they are."""

from pathlib import Path

import numpy as np
import pytest

from hil.errors import InputError
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.uneven_floor import CELL, UnevenFloor
from sim_backends.virtual.motors import nominal_motors
from tests.sim_backends.conftest import hold, run

GRAVITY = 9.81


def stand(plant, seconds=1.5):
    hold(plant)
    plant.set_support(False)
    run(plant, seconds)
    return plant


def test_feelers_on_a_flat_floor_are_the_sole(make_plant):
    flat, felt = stand(make_plant()), stand(make_plant("floor_height=1e-12"))
    np.testing.assert_allclose(felt.truth().base_position, flat.truth().base_position, atol=1e-5)
    np.testing.assert_allclose(felt.foot_force(), flat.foot_force(), atol=0.05)


def test_an_uneven_floor_loads_corners_unequally_and_carries_the_weight(make_plant):
    flat, uneven = stand(make_plant()), stand(make_plant("floor_height=0.001", seed=2))
    weight = uneven.model.body_mass.sum() * GRAVITY
    force = uneven.foot_force()
    assert force.sum() == pytest.approx(weight, rel=0.05)
    assert force.std() > 2 * flat.foot_force().std()


@pytest.fixture
def floor(make_plant):
    plant = make_plant("floor_height=0.001", seed=1)
    return UnevenFloor(plant.model, plant.data, (-0.001, 0.001), 1)


def test_heights_are_bounded_continuous_and_vary_within_a_sole(floor):
    line = np.array([floor.at(x, 0.03) for x in np.arange(-1.0, 1.0, 0.001)])
    assert np.abs(line).max() <= 0.001
    assert np.abs(np.diff(line)).max() < 0.002 / CELL * 0.001 * 1.01
    assert np.ptp(line[:120]) > 1e-4
    assert floor.at(0.2, 0.3) == pytest.approx(floor.at(0.2 + 6.4, 0.3 - 6.4))


def test_the_floor_follows_corners_in_the_air_and_stays_under_those_that_stand(make_plant):
    plant = stand(make_plant("floor_height=0.001", seed=1), 1.0)
    floor = plant._floor
    before = plant.model.geom_pos[floor._planes, 2].copy()
    plant.data.qpos[0] += 0.03
    plant.substep()
    floor.follow()
    down = plant.model.geom_pos[floor._planes, 2]
    standing = plant.foot_force().ravel() > 0.5
    assert standing.sum() >= 4
    np.testing.assert_array_equal(down[standing], before[standing])
    plant.data.qpos[2] += 0.05
    plant.step()
    after = plant.model.geom_pos[floor._planes, 2]
    heights = [floor.at(x, y) for x, y, _ in plant.data.geom_xpos[floor._feelers]]
    np.testing.assert_allclose(after, heights, atol=2e-4)


def test_another_seed_is_another_floor(floor, make_plant):
    plant = make_plant("floor_height=0.001")
    other = UnevenFloor(plant.model, plant.data, (-0.001, 0.001), 7)
    assert floor.at(0.03, 0.04) != other.at(0.03, 0.04)


def test_toes_feel_too():
    plant = Plant(load_robot("human", ("floor_height=0.005",)), 300)
    assert len(plant._floor._feelers) == 16


def test_only_boxes_have_corners(tmp_path, minibiped):
    text = minibiped.model_path.read_text().replace(
        'name="left_sole" type="box"', 'name="left_sole" type="ellipsoid"'
    )
    (tmp_path / "minibiped.xml").write_text(text)
    file = tmp_path / "minibiped.yaml"
    file.write_text(Path(minibiped.file).read_text())
    description = load_robot(str(file))
    with pytest.raises(InputError, match="'left_sole' is no box"):
        Plant(description, 300, motors=nominal_motors(description))
