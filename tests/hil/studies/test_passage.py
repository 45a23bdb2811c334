"""The lean walk of the searches is that of `stride walk`."""

import numpy as np

from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Schedules
from hil.studies.passage import pass_by
from hil.studies.walks import walk


def request(**values):
    schedules = Schedules(lateral=((0.0, 0.0), (0.8, 0.0), (0.8, 0.2)))
    description = load_robot("human")
    return RunRequest(robot="human", schedules=schedules, **values).resolved(description)


def test_a_passage_is_the_walk_to_the_last_bit():
    asked = request(rate_hz=300, duration_s=1.5)
    lean, whole = pass_by(asked, load_robot("human")), walk(asked).trace
    assert lean.stopped_s is None
    for name in ("time_s", "base_position", "base_orientation", "joint_position", "heading"):
        assert np.array_equal(getattr(lean, name)[1:], getattr(whole, name)[1:]), name


def test_a_fall_ends_it_early():
    lean = pass_by(request(rate_hz=120, pd="explicit", duration_s=10.0), load_robot("human"))
    assert lean.stopped_s < 5.0
    assert len(lean.time_s) == round(lean.stopped_s * 120) + 1
    height = lean.base_position[:, 2] / lean.base_position[0, 2]
    assert 0.8 < height[-2] < 1.2
    assert not 0.8 < height[-1] < 1.2


def test_a_robot_that_starts_standing_passes_by_as_well():
    biped = load_robot("minibiped")
    asked = RunRequest(robot="minibiped", backend="mujoco", duration_s=0.5).resolved(biped)
    passage = pass_by(asked, biped)
    assert passage.stopped_s is None
    assert len(passage.time_s) == 150
