"""The controller again on recorded frames: the same, or what differs, and from when."""

import json
import shutil

import numpy as np
import pytest
from hil_fakes import make_session
from typer.testing import CliRunner

from hil.after.rerun import rerun, rerun_parts
from hil.after.ticks import recorded_ticks
from hil.cli.main import app
from hil.compose import build
from hil.errors import InputError
from hil.export import write_mcap
from hil.record_layout import TickWriter, tick_dtype
from hil.recording import Recording, read_recording
from hil.request import RunRequest
from hil.run import run


def stride(*arguments):
    return CliRunner().invoke(app, list(map(str, arguments)))


@pytest.fixture(autouse=True)
def undrawn(monkeypatch):
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)


@pytest.fixture(scope="module")
def recording(short_walk):
    return read_recording(short_walk)


def changed(recording, edit):
    rows = recording.rows.copy()
    edit(rows)
    return Recording(recording.meta, rows, complete=True)


def again(recording, *overrides, tolerance=0.0):
    return rerun(recording, rerun_parts(recording, "walk", overrides), tolerance)


@pytest.mark.parametrize(
    "request_",
    [
        {"robot": "minibiped", "backend": "bus", "duration_s": 1.0},
        {"robot": "minibiped", "backend": "mujoco", "hoisted": True, "duration_s": 1.0},
        {"robot": "minibiped", "backend": "mujoco", "activity": "stand", "duration_s": 0.5},
        {"robot": "human", "duration_s": 0.7, "stabilizer": True},
    ],
)
def test_every_kind_of_run_is_the_same_to_the_last_bit(tmp_path, request_):
    folder = tmp_path / "run"
    report = run(build(RunRequest.checked(**request_, out=folder)), progress=False).report
    done = again(read_recording(folder))
    assert done.identical and done.raised is None
    assert done.commands == round(report["duration_s"] * report["rate_hz"])
    assert done.estimated is (request_["robot"] == "minibiped")


def test_one_number_of_one_tick_is_found(recording):
    def edit(rows):
        tick = int(np.flatnonzero(rows["timing"]["tick"] == 500)[0])
        rows["command"]["position"][tick, 3] += 2e-4
        rows["command"]["torque"][tick + 10, 3] = np.nan

    done = again(changed(recording, edit))
    assert [(one.topic, one.field, one.element) for one in done.differences] == [
        ("command", "position", "left_knee"),
        ("command", "torque", "left_knee"),
    ]
    first, second = done.differences
    assert (first.first_tick, first.ticks, first.unit) == (500, 1, "rad")
    assert first.time_s == pytest.approx(500 / 300)
    assert first.largest == pytest.approx(2e-4)
    assert second.first_tick == 510
    assert second.largest == np.inf
    assert done.as_dict()["differences"][1]["largest"] is None
    assert len(again(changed(recording, edit), tolerance=1e-3).differences) == 1


def test_what_a_changed_frame_changes_begins_there(recording):
    def edit(rows):
        later = rows["timing"]["tick"] >= 450
        rows["frame"]["joint_position"][later, 3] += 0.01

    done = again(changed(recording, edit))
    assert min(one.first_tick for one in done.differences) == 450
    touched = {(one.topic, one.element) for one in done.differences}
    assert ("estimate", "left_knee") in touched
    assert any(topic == "command" for topic, _ in touched)


def test_a_changed_setting_is_what_would_have_been_said(short_walk):
    result = stride("replay", short_walk, "--set", "walking.swing.height=0.03", "--json")
    assert result.exit_code == 1
    data = json.loads(result.stdout)
    assert not data["identical"]
    assert {one["topic"] for one in data["differences"]} == {"command"}
    assert all(one["first_tick"] > 0 for one in data["differences"])


def test_the_command_says_identical_and_what_is_different(short_walk, tmp_path):
    result = stride("replay", short_walk)
    assert (result.exit_code, result.stdout.splitlines()[-1]) == (0, "identical")
    recording = read_recording(short_walk)

    def edit(rows):
        rows["command"]["position"][-1, 0] += 1.0
        rows["command"]["position"][600:, 9] -= 0.5

    shutil.copy(short_walk / "meta.json", tmp_path)
    write_mcap(changed(recording, edit), tmp_path / "session.mcap")
    result = stride("replay", tmp_path)
    assert result.exit_code == 1
    assert "right_knee" in result.stdout
    assert "0.5" in result.stdout
    assert result.stdout.splitlines()[-1] == "different"


class Raising:
    """Raises in one of its steps."""

    def __init__(self, controller, step):
        self._controller, self._left = controller, step
        self.status = controller.status

    def step(self, estimate, reference):
        if self._left == 0:
            raise ZeroDivisionError("no way")
        self._left -= 1
        return self._controller.step(estimate, reference)


def test_a_controller_that_raises_is_told_with_its_time(recording):
    parts = rerun_parts(recording, "walk")
    raising = type(parts)(parts.estimator, Raising(parts.controller, 300))
    done = rerun(recording, raising)
    assert not done.identical and not done.raised_then
    assert done.raised == "ZeroDivisionError: no way (t = 1.000 s)"
    assert done.differences == []


def test_a_run_that_raised_raises_again(tmp_path, monkeypatch):
    session = build(
        RunRequest.checked(backend="mujoco", duration_s=1.0, seed=1, out=tmp_path / "run")
    )
    step, session.controller.steps = session.controller.step, 0

    def raising(estimate, reference):
        session.controller.steps += 1
        if session.controller.steps > 150:
            raise ZeroDivisionError("no way")
        return step(estimate, reference)

    monkeypatch.setattr(session.controller, "step", raising)
    with pytest.raises(ZeroDivisionError):
        run(session, progress=False)
    recording = read_recording(tmp_path / "run")
    parts = rerun_parts(recording, "run")
    done = rerun(recording, type(parts)(parts.estimator, Raising(parts.controller, 150)))
    assert done.raised_then and done.identical
    assert done.raised == "ZeroDivisionError: no way (t = 0.500 s)"
    healed = rerun(recording, rerun_parts(recording, "run"))
    assert healed.raised is None and healed.mended and not healed.identical


def test_a_twin_and_a_wrong_folder_are_refused(short_walk, tmp_path):
    recording = read_recording(short_walk)
    twin = Recording({**recording.meta, "rung": "twin"}, recording.rows, complete=True)
    with pytest.raises(InputError, match="is a twin"):
        rerun_parts(twin, "walk")
    assert stride("replay", tmp_path).exit_code == 2
    assert stride("replay", short_walk, "--set", "walking.nonsense=1").exit_code == 2


def test_a_changed_robot_file_is_told(short_walk, tmp_path):
    recording = read_recording(short_walk)
    meta = {**recording.meta, "description_sha256": "0" * 64}
    write_mcap(Recording(meta, recording.rows[:200], complete=True), tmp_path / "session.mcap")
    result = stride("replay", tmp_path)
    assert result.exit_code == 0
    assert "minibiped.yaml: is not what it was" in result.stderr


def test_played_ticks_are_what_was_recorded(tmp_path):
    run(make_session(world=True, out=tmp_path / "fake", duration_s=0.5), progress=False)
    recording = read_recording(tmp_path / "fake")
    rows = np.zeros(len(recording.rows), tick_dtype(12, truth=True))
    writer = TickWriter(rows)
    for index, record in enumerate(recorded_ticks(recording)):
        writer.write(index, record)
    assert len(rows) == 930
    for name in recording.rows.dtype.names:
        for field in recording.rows.dtype[name].names or ():
            ours, theirs = rows[name][field], recording.rows[name][field]
            assert np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f"), (name, field)
    assert np.array_equal(rows["time_ns"], recording.rows["time_ns"])
