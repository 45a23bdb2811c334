"""Runs with faults: when they begin, what the report says, what the command line says."""

import json

from hil_fakes import make_session
from hil_walks import walk
from typer.testing import CliRunner

from hil.cli.main import app
from hil.compose import build
from hil.fault_spec import gather_faults
from hil.loop import Outcome
from hil.report import make_report
from hil.request import RunRequest
from hil.run import run
from hil.safety.severity import Fault

QUIET = ("plant.draws=null",)


def run_with(tmp_path, *faults, duration_s=0.3):
    request = RunRequest(
        faults=gather_faults(faults, None),
        duration_s=duration_s,
        out=tmp_path / "run",
        overrides=QUIET,
    )
    return run(build(request), progress=False)


def test_faults_begin_at_the_first_walking_tick_plus_t(tmp_path):
    report = run_with(tmp_path, "board:imu:stale@0.1").report
    injected, reaction = report["faults"][:2]
    assert injected == {
        "time_s": 0.1, "source": "board:imu", "name": "injected stale", "reaction": "none",
    }  # fmt: skip
    assert "imu" in reaction["source"]
    assert reaction["reaction"] != "none"
    assert 0.1 < reaction["time_s"] < 0.2
    meta = json.loads((tmp_path / "run" / "meta.json").read_text())
    assert meta["request"]["faults"][0]["kind"] == "stale"


def test_a_run_is_the_same_for_its_seed_whatever_is_lost(tmp_path):
    reports = [
        run_with(tmp_path / name, "bus:*:drop=0.05@0", "bus:*:flip=0.05@0").report
        for name in ("a", "b")
    ]
    keys = ("bus_timeouts", "bus_stale_frames", "bus_crc_errors", "distance_m", "faults")
    assert [reports[0][key] for key in keys] == [reports[1][key] for key in keys]
    assert reports[0]["bus_stale_frames"] > 0


def test_injected_faults_are_listed_if_they_came_to_pass():
    session = make_session(faults=gather_faults(["bus:*:drop@1", "bus:*:flip@99"], None))
    outcome = Outcome(faults=[Fault(2.0, "left_knee", "silent", "soft_stop")])
    report = make_report(session.request, "minibiped", outcome, walk(20.0), 25.0, {}, truth=True)
    assert [fault["name"] for fault in report["faults"]] == ["injected drop", "silent"]


def test_the_command_line_tells_a_mistake_in_one_line_and_starts_nothing(tmp_path):
    arguments = ["walk", "--out", str(tmp_path / "run"), "--fault", "servo:left_toe:silent"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 2
    assert "unknown joint in --fault 'left_toe'; valid: left_hip_yaw" in result.output
    assert not (tmp_path / "run").exists()
