"""A run's goals through a virtual robot that is carried."""

import json

import numpy as np
import pytest
from hil_fakes import make_session
from typer.testing import CliRunner

from hil.after.comparison import compare_runs
from hil.after.recorded import TWIN, read_run
from hil.after.replay import replay, replay_folder, twin_request
from hil.cli.main import app
from hil.compose import build
from hil.recording import read_recording
from hil.request import RunRequest
from hil.run import run
from hil.schedule import Push, Schedules


@pytest.fixture(autouse=True)
def undrawn(monkeypatch):
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)


@pytest.fixture(scope="module")
def dry(tmp_path_factory):
    """A short dry run that ends in a fall."""
    folder = tmp_path_factory.mktemp("dry") / "run"
    fatal = Push(force=(0.0, 40.0, 0.0), start=3.0, duration=0.5)
    request = RunRequest.checked(
        seed=1,
        duration_s=5.0,
        overrides=("plant.draws=null",),
        schedules=Schedules(pushes=(fatal,)),
        out=folder,
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hil.run.draw_run", lambda *_: None)
        report = run(build(request), progress=False).report
    assert report["fell"]
    return folder


def twin_of(folder, out, *changes):
    recorded = replay_folder(folder)
    return replay(recorded, twin_request(recorded, None, changes, None, out), progress=False)


def test_a_twin_is_told_what_the_run_told_its_servos_and_does_the_same(dry, tmp_path):
    done = twin_of(dry, tmp_path / "twin")
    rows, other = read_recording(dry).rows, read_recording(done).rows
    rows = rows[(rows["applied"]["p_gain"] > 0).any(axis=1)]
    for topic, name in (("timing", "tick"), ("applied", "goal"), ("applied", "p_gain"),
                        ("command", "torque"), ("status", "phase")):  # fmt: skip
        assert np.array_equal(rows[topic][name], other[topic][name]), name
    walked = (rows["time_s"] > 0.5) & (rows["time_s"] < 3.0)
    apart = rows["frame"]["joint_position"] - other["frame"]["joint_position"]
    assert np.degrees(np.sqrt((apart[walked] ** 2).mean(axis=0))).max() < 0.5
    carried = other["truth"]["base_position"] - rows["estimate"]["base_position"]
    assert np.abs(carried[walked]).max() < 0.004
    loads = np.abs(other["frame"]["foot_force"] - rows["frame"]["foot_force"])[walked]
    assert loads.mean() < 1.0
    meta = json.loads((done / "meta.json").read_text())
    assert meta["rung"] == TWIN
    assert meta["twin_of"]["name"] == "run"
    found = compare_runs(read_run(done), read_run(dry))
    assert found.curves.aligned == "tick"
    assert [str(one) for one in found.findings] == []


def test_the_command_says_what_the_robot_has_that_its_twin_has_not(dry, tmp_path):
    change = "plant.joint_friction={left_knee: 0.35}"
    result = CliRunner().invoke(app, ["twin", str(dry), "--set", change, "--json",
                                      "--out", str(tmp_path / "twin")])  # fmt: skip
    assert result.exit_code == 0, result.output
    data = json.loads(result.stdout)
    assert data["joints"][0]["joint"] == "left_knee"
    first = data["causes"][0]
    assert (first["cause"], first["joint"]) == ("friction", "left_knee")
    assert first["difference"] == pytest.approx(-0.25, abs=0.08)
    assert (tmp_path / "twin" / "joints.png").read_bytes().startswith(b"\x89PNG")


def test_a_twin_has_no_twin_and_a_run_without_registers_neither(tmp_path):
    run(make_session(world=True, out=tmp_path / "fake", duration_s=2.0), progress=False)
    result = CliRunner().invoke(app, ["twin", str(tmp_path / "fake")])
    assert result.exit_code == 2
    assert "registers" in result.output
    (tmp_path / "fake" / "samples.csv").touch()
    assert "is a jog" in CliRunner().invoke(app, ["twin", str(tmp_path / "fake")]).output
    result = CliRunner().invoke(app, ["twin", str(tmp_path / "nothing")])
    assert result.exit_code == 2
    assert "no session.mcap" in result.output


def test_a_real_robots_twin_is_the_nominal_one(dry):
    recorded = replay_folder(dry)
    recorded.meta["rung"] = "live"
    recorded.meta["request"]["overrides"] = ["plant.hoist=true", "plant.mass_scale=1.1"]
    request = twin_request(recorded, None, ("noise.gyro=0.0",), None, None)
    assert request.overrides == ("plant.draws=null", "plant.mass_scale=1.1", "noise.gyro=0.0")
    assert not request.live
    assert twin_request(recorded, "other.yaml", (), 7, None).overrides == ()
