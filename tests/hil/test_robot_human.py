"""human: the checked-in model is the derivation's, and the character is the seeds'."""

import mujoco
import numpy as np
import pytest

from hil.robot_files import load_robot
from hil.robots.human.derivation import mjcf


@pytest.fixture(scope="module")
def human():
    return load_robot("human")


@pytest.fixture(scope="module")
def model(human):
    return mujoco.MjModel.from_xml_path(str(human.model_path))


def test_checked_in_model_is_what_the_derivation_writes(human):
    assert human.model_path.read_text() == mjcf()


def test_size_of_the_published_character(model):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert (model.nv, model.njnt) == (34, 29)
    assert model.body_mass.sum() == pytest.approx(70.4)
    assert data.subtree_com[1][2] == pytest.approx(1.114, abs=1e-3)
    assert data.body("head").xpos[2] == pytest.approx(1.695, abs=1e-3)
    lowest = {name: data.geom(name).xpos[2] - model.geom(name).size[2]
              for name in ("left_sole", "right_sole", "left_toe", "right_toe")}  # fmt: skip
    assert lowest == pytest.approx(
        {"left_sole": 0.002, "right_sole": 0.002, "left_toe": 0.0, "right_toe": 0.0}, abs=1e-9
    )


def test_joints_and_ranges_are_those_of_the_model(human, model):
    names = [model.joint(i).name for i in range(1, model.njnt)]
    assert names == list(human.joint_names)
    for joint in human.joints:
        assert tuple(model.joint(joint.name).range) == pytest.approx(joint.range)
    assert len(names) == 28


def test_left_and_right_mirror_each_other(human, model):
    for i in range(model.nbody):
        left = model.body(i)
        if not left.name.startswith("left_"):
            continue
        right = model.body(left.name.replace("left", "right"))
        assert left.mass == right.mass
        assert np.allclose(left.inertia, right.inertia)
        assert np.allclose(left.pos * [1, -1, 1], right.pos)


def test_middle_hinge_of_a_ball_joint_stays_off_its_singularity(human):
    """The middle angle of the start pose is small; the arms' first hinge turns them down."""
    start = dict(zip(human.joint_names, human.start_position, strict=True))
    for name in human.joint_names:
        if name.endswith("_yaw") and "shoulder" in name:
            assert abs(start[name]) < 0.3
        if name.endswith("_roll") and ("hip" in name or name.startswith(("back", "neck"))):
            assert abs(start[name]) < 0.1


def test_only_soles_and_toes_touch_the_floor(model):
    touching = {model.geom(i).name for i in range(model.ngeom)
                if model.geom(i).conaffinity[0]}  # fmt: skip
    assert touching == {"left_sole", "right_sole", "left_toe", "right_toe"}
