"""What is set of one joint alone: `--set plant.joint_friction={left_knee: 0.2}`."""

import json

import numpy as np
import pytest

from hil.errors import DescriptionError, UnknownNameError
from hil.robot_files import load_robot
from sim_backends.draws import hidden_values

KNEE = 3


def hidden(*overrides, seed=5):
    return hidden_values(load_robot("minibiped", overrides), seed)


@pytest.mark.parametrize("key", ["armature", "joint_friction", "torque_constant_scale",
                                 "joint_zero", "backlash"])  # fmt: skip
def test_one_joint_gets_the_value_and_the_others_keep_their_draws(key):
    free = getattr(hidden(), key)
    fixed = getattr(hidden(f"plant.{key}={{left_knee: 0.2}}"), key)
    assert fixed[KNEE] == 0.2
    assert np.array_equal(np.delete(fixed, KNEE), np.delete(free, KNEE))


def test_the_others_of_a_nominal_robot_stay_nominal(make_plant):
    plant = make_plant("plant.joint_friction={left_knee: 0.2}", "plant.draws=null")
    friction = plant.model.dof_frictionloss[-12:]
    assert friction[KNEE] == 0.2
    assert np.delete(friction, KNEE) == pytest.approx(0.1)  # the MJCF's
    found = plant.hidden.as_dict()
    assert found["joint_friction"][KNEE] == 0.2
    assert found["joint_friction"][0] is None
    json.dumps(found, allow_nan=False)
    zeros = hidden("plant.joint_zero={left_knee: 0.03}", "plant.draws=null").joint_zero
    assert zeros.tolist() == [0.03 if joint == KNEE else 0.0 for joint in range(12)]


def test_an_unknown_joint_and_an_impossible_value_are_refused():
    with pytest.raises(UnknownNameError, match=r"joint_friction.*left_nee.*left_knee"):
        hidden("plant.joint_friction={left_nee: 0.2}")
    with pytest.raises(DescriptionError, match="joint_friction"):
        hidden("plant.joint_friction={left_knee: -0.2}")
