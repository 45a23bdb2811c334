"""What the view makes of a tick: poses, marks around the robot, timing."""

import os
import socket
import time

import mujoco
import numpy as np
import pytest

from hil.record_layout import tick_dtype
from hil.recorder_ring import Ring
from hil.robot_files import load_robot
from hil.steering.words import Word
from hil.view.live import LiveRun
from hil.view.overlay import COP, FOOTHOLD, FORCE, SUPPORT, WATER, Overlay
from hil.view.stage import Stage, stage_model


@pytest.fixture(scope="module", params=["minibiped", "human"])
def scene(request):
    description = load_robot(request.param)
    model = stage_model(description)
    return description, model, Stage(description, model)


def tick(description):
    row = np.zeros(1, tick_dtype(len(description.joints), truth=True))[0]
    row["estimate"]["base_orientation"] = [1, 0, 0, 0]
    row["estimate"]["joint_position"] = description.start_position
    return row


def draw(scene, row):
    _, model, stage = scene
    data, geoms = mujoco.MjData(model), []
    stage.place(model, data, row["estimate"])
    Overlay(stage, geoms).draw(data, row, row["estimate"])
    return stage, data, geoms


def of(geoms, colour):
    return [geom for geom in geoms if np.allclose(geom.rgba, colour)]


def test_the_model_takes_the_recorded_pose(scene):
    description = scene[0]
    row = tick(description)
    row["estimate"]["base_position"] = [3.0, -2.0, 0.4]
    _, data, _ = draw(scene, row)
    assert data.body(description.root).xpos == pytest.approx([3.0, -2.0, 0.4])
    for name, angle in zip(description.joint_names, description.start_position, strict=True):
        assert data.joint(name).qpos[0] == pytest.approx(angle)


def test_there_is_one_floor_and_it_is_no_obstacle_to_the_eye(scene):
    _, model, _ = scene
    assert (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE).sum() == 1


def test_an_arrow_stands_on_each_corner_that_carries_as_long_as_its_load(scene):
    row = tick(scene[0])
    row["estimate"]["foot_force"] = [[2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 4.0]]
    stage, data, geoms = draw(scene, row)
    arrows = of(geoms, FORCE)
    corners = stage.corners(data)
    assert arrows[0].pos == pytest.approx(corners[0, 0], abs=1e-6)
    assert arrows[1].pos == pytest.approx(corners[1, 3], abs=1e-6)
    assert arrows[1].size[2] == pytest.approx(2 * arrows[0].size[2], rel=1e-3)
    assert corners[0, 0, 0] > corners[0, 2, 0] and corners[0, 0, 1] > corners[0, 1, 1]


def test_the_centre_of_pressure_is_in_the_support_of_the_feet_that_carry(scene):
    row = tick(scene[0])
    stage, data, geoms = draw(scene, row)
    assert not of(geoms, SUPPORT) and not of(geoms, COP)  # in the air
    row["estimate"]["foot_force"][0] = stage.weight / 4
    _, data, geoms = draw(scene, row)
    left = stage.corners(data)[0, :, :2]
    (cop,) = of(geoms, COP)
    assert cop.pos[:2] == pytest.approx(left.mean(axis=0), abs=1e-6)
    assert len(of(geoms, SUPPORT)) == 4
    row["estimate"]["foot_force"][1] = stage.weight / 4
    assert len(of(draw(scene, row)[2], SUPPORT)) > 3


def test_the_foothold_is_drawn_while_it_walks(scene):
    row = tick(scene[0])
    row["status"]["foot_target"] = [0.3, 0.1, 0.05]
    assert not of(draw(scene, row)[2], FOOTHOLD)
    row["status"]["walking"] = True
    plate = of(draw(scene, row)[2], FOOTHOLD)[0]
    assert plate.pos[:2] == pytest.approx([0.3, 0.1], abs=1e-6)


def test_water_is_as_deep_as_it_is_said_to_be(scene):
    row = tick(scene[0])
    row["reference"]["water_level"] = 0.3
    (water,) = of(draw(scene, row)[2], WATER)
    assert water.pos[2] + water.size[2] == pytest.approx(0.3, abs=1e-6)


@pytest.fixture
def link():
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    yield ours, theirs
    ours.close()
    theirs.close()


def put(ring, ticks):
    for number in ticks:
        row = ring.rows[ring.next_row]
        row["timing"]["tick"] = number
        row["timing"]["cycle_ns"] = 1_000_000 + number
        ring.publish()


def test_the_view_keeps_the_newest_tick_and_the_last_timings(link):
    ring = Ring.create(tick_dtype(12, truth=False))
    live = LiveRun(ring, link[1], os.getppid())
    assert not live.update()
    put(ring, range(1, 2001))
    assert live.update()
    assert live.row["timing"]["tick"] == 2000 and ring.waiting == 0
    assert sorted(live.cycle_ns())[0] == 1_000_501 and len(live.cycle_ns()) == 1500
    assert live.skipped == 0
    put(ring, [2001, 2004, 2005])
    live.update()
    assert live.skipped == 2
    os.close(ring.descriptor)


def test_the_view_speaks_and_listens_without_waiting(link):
    ring = Ring.create(tick_dtype(12, truth=False))
    live = LiveRun(ring, link[1], os.getppid())
    link[0].send(b'{"faults": [1]}')
    link[0].send(b'{"faults": [1, 2]}')
    live.update()
    assert live.facts == {"faults": [1, 2]}
    live.say(Word("speed", (0.25,)))
    live.stop("off")
    assert [link[0].recv(100) for _ in range(2)] == [b"speed 0.25", b"off"]
    began = time.monotonic()
    for _ in range(5000):  # nobody reads: its queue is full soon
        live.say(Word("alive"))
    assert time.monotonic() - began < 5
    link[0].close()
    live.say(Word("alive"))
    live.update()
    os.close(ring.descriptor)


def test_a_run_that_is_over_is_over(link):
    ring = Ring.create(tick_dtype(12, truth=False))
    live = LiveRun(ring, link[1], os.getppid())
    assert not live.over
    ring.finish()
    assert live.over
    assert LiveRun(Ring.create(ring.rows.dtype), link[1], 1).over == (os.getppid() != 1)
    os.close(ring.descriptor)
