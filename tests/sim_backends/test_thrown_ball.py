"""The thrown ball hits the trunk, at the speed that was asked for, with all its momentum."""

import numpy as np
import pytest

from hil.errors import BackendError
from hil.robot_files import load_robot
from sim_backends.plant import Plant


@pytest.mark.parametrize("velocity", [(0.0, 5.4, 0.0), (-5.4, 0.0, 0.0)])
def test_ball_gives_the_human_its_momentum(velocity):
    human = load_robot("human", ("plant.ball=true",))
    plant = Plant(human, 300)
    plant.set_support(False)
    plant.model.opt.gravity[:] = 0.0  # neither falls: all that changes is the ball's doing
    plant.data.qvel[:] = 0.0
    plant.throw_ball(5.0, np.array(velocity))
    for _ in range(90):  # 0.3 s; the way takes 0.1 s
        plant.step()
    mass = 70.4
    gained = plant.truth().com_velocity * mass
    # Between a plastic impact and an elastic one.
    direction = np.array(velocity) / 5.4
    share = gained @ direction / (5.0 * 5.4)
    assert 0.85 < share < 2.0
    assert np.linalg.norm(gained - (gained @ direction) * direction) < 0.25 * np.linalg.norm(gained)


def test_ball_meets_the_trunk_where_and_when_it_should():
    human = load_robot("human", ("plant.ball=true",))
    plant = Plant(human, 300)
    trunk, ball = plant.model.body("torso").id, plant.model.body("thrown_ball").id
    plant.throw_ball(5.0, np.array([0.0, 5.4, 0.0]))
    gaps = []
    for _ in range(25):
        plant.step()
        gaps.append(np.linalg.norm(plant.data.xipos[ball] - plant.data.xipos[trunk]))
    radii = 0.126 + 0.11
    assert min(gaps) == pytest.approx(radii, abs=0.04)
    assert 20 <= int(np.argmin(gaps)) < 25


def test_waiting_ball_changes_nothing():
    nominal = Plant(load_robot("human"), 300)
    waiting = Plant(load_robot("human", ("plant.ball=true",)), 300)
    for plant in (nominal, waiting):
        for _ in range(60):
            plant.step()
    assert np.allclose(nominal.truth().com, waiting.truth().com, atol=1e-9)


def test_without_a_ball_says_how_to_get_one():
    with pytest.raises(BackendError, match=r"plant\.ball=true"):
        Plant(load_robot("human"), 300).throw_ball(5.0, np.array([1.0, 0.0, 0.0]))
