"""What a seed hides is the same robot on both backends, and is told in meta.json alone."""

from contextlib import closing

import pytest

from hil.compose import build
from hil.request import RunRequest


def session(seed=3, **more):
    return build(RunRequest(robot="minibiped", seed=seed, **more))


def test_meta_tells_what_the_plant_has_on_both_backends():
    found = []
    for backend in ("mujoco", "bus"):
        with closing(session(backend=backend)) as made:
            assert made.meta["hidden"] == made.world.hidden.as_dict()
            found.append(made.meta["hidden"])
    assert found[0] == found[1]
    assert len(found[0]["armature"]) == 12


def test_a_nominal_robot_says_so():
    with closing(session(backend="mujoco", overrides=("plant.draws=null",))) as made:
        hidden = made.meta["hidden"]
    assert set(hidden["torque_constant_scale"]) == {1.0}
    assert not any(hidden["backlash"])
    assert "armature" not in hidden


@pytest.mark.parametrize("backend", ["mujoco", "bus"])
def test_sensors_do_not_show_it(backend):
    """Two robots that differ in what is hidden, at rest: the same first joint torques."""
    torques = []
    for scale in (0.75, 1.25):
        with closing(
            session(backend=backend, overrides=(f"plant.torque_constant_scale={scale}",))
        ) as made:
            made.backend.open()
            torques.append(made.backend.read().joint_torque.copy())
    assert (torques[0] == torques[1]).all()
