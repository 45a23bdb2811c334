import json
from contextlib import nullcontext
from dataclasses import replace

import pytest
from hil_fakes import make_session

from hil.errors import BackendError, InputError
from hil.recording import read_recording
from hil.run import run
from hil.run_folder import make_run_folder

FILES = ["meta.json", "picture.png", "report.json", "session.mcap"]


def test_a_run_leaves_its_four_files_and_a_second_report(tmp_path):
    out, copy = tmp_path / "run", tmp_path / "copy.json"
    session = make_session(world=True, out=out, report=copy, seed=7)
    result = run(session, progress=False)
    assert result.folder == out
    assert sorted(path.name for path in out.iterdir()) == FILES
    assert json.loads((out / "report.json").read_text()) == result.report
    assert copy.read_text() == (out / "report.json").read_text()
    meta = json.loads((out / "meta.json").read_text())
    assert meta["changes"] == ["left_knee: Return Delay Time 250 -> 0"]
    assert (meta["seed"], meta["rung"], meta["request"]["duration_s"]) == (7, "dry run", 1.0)
    assert meta["weight_n"] == pytest.approx(2.6 * 9.81, rel=0.05)
    assert meta == read_recording(out).meta
    assert (out / "picture.png").read_bytes().startswith(b"\x89PNG")


def test_a_run_that_breaks_leaves_what_it_had_and_says_why(tmp_path):
    session = make_session(world=True, out=tmp_path / "run")
    session.controller.raising = BackendError("port lost")
    with pytest.raises(BackendError, match="port lost"):
        run(session, progress=False)
    report = json.loads((tmp_path / "run" / "report.json").read_text())
    assert [fault["name"] for fault in report["faults"]] == ["BackendError"]
    recording = read_recording(tmp_path / "run")
    assert recording.complete and len(recording.rows) > 0


def test_a_backend_that_does_not_open_leaves_no_folder_and_nothing_open(tmp_path):
    session = make_session(out=tmp_path / "run")
    session.backend.raise_in["open"] = InputError("no such port")
    with pytest.raises(InputError, match="no such port"):
        run(session, progress=False)
    assert not (tmp_path / "run").exists()
    assert session.backend.journal == ["open", "close"]


def closing(session):
    """The session with two closers that write into its backend's journal."""
    journal = session.backend.journal
    closers = (lambda: journal.append("world closed"), lambda: journal.append("server ended"))
    return replace(session, closers=closers)


@pytest.mark.parametrize("stage", ["open", "write", None])
def test_what_was_started_for_a_run_is_ended_whatever_happens(tmp_path, stage):
    session = closing(make_session(out=tmp_path / "run"))
    if stage is not None:
        session.backend.raise_in[stage] = BackendError("port lost")
    with pytest.raises(BackendError) if stage is not None else nullcontext():
        run(session, progress=False)
    assert session.backend.journal[-3:] == ["close", "world closed", "server ended"]


def test_a_part_that_cannot_be_closed_does_not_keep_the_others_open(tmp_path):
    session = closing(make_session(out=tmp_path / "run"))
    session.backend.close = broken_close
    with pytest.raises(OSError, match="gone"):
        run(session, progress=False)
    assert session.backend.journal[-2:] == ["world closed", "server ended"]


def broken_close():
    raise OSError("gone")


def test_figures_of_the_session_fill_what_the_backend_does_not_know(tmp_path):
    session = make_session(out=tmp_path / "run")
    session.backend.statistics = lambda: {"energy_wh": None, "voltage_min_v": 11.5}
    figures = {"energy_wh": 0.25, "voltage_min_v": 1.0, "torque_rms_ratio_max": 0.1 + 0.2}
    report = run(replace(session, figures=lambda: figures), progress=False).report
    assert (report["energy_wh"], report["voltage_min_v"]) == (0.25, 11.5)
    assert report["torque_rms_ratio_max"] == 0.3
    assert report["target_speed_mps"] == 0.15


def test_a_folder_that_holds_something_is_not_written_into(tmp_path):
    (tmp_path / "note.txt").write_text("mine")
    session = make_session(out=tmp_path)
    with pytest.raises(InputError, match="not empty"):
        run(session, progress=False)
    assert session.backend.journal == ["open", "close"]


def test_runs_of_the_same_second_get_folders_of_their_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folders = {make_run_folder(None, "minibiped") for _ in range(3)}
    assert len(folders) == 3
    assert all(folder.parent.name == "runs" for folder in folders)
