"""The command line as a user meets it: bad input, exit codes, what is printed."""

import csv
import io
import json
import subprocess
import sys

import pytest
from hil_fakes import make_session
from typer.testing import CliRunner

from hil.cli.main import app
from hil.errors import BackendError
from hil.run import run

STRIDE = [sys.executable, "-c", "from hil.cli.main import main; main()"]
BAD_INPUT = [
    ["walk", "atlas"],
    ["walk", "missing.yaml"],
    ["walk", "--speed", "fast"],
    ["walk", "--speed", "nan"],
    ["walk", "--turn", "90"],
    ["walk", "--push", "1,2@3"],
    ["walk", "--duration", "-3"],
    ["walk", "--duration", "inf"],
    ["walk", "--rate", "100000"],
    ["walk", "--step-width", "0"],
    ["walk", "--water=-0.1"],
    ["walk", "--water", "deep"],
    ["walk", "--water", "0.1", "--viscosity", "0"],
    ["walk", "--density", "1100"],
    ["walk", "--bus", "real"],
    ["walk", "--live"],
    ["walk", "--set", "colour=red"],
    ["walk", "--set", "mass_scale"],
    ["walk", "--set", "voltage=high"],
    ["walk", "human", "--backend", "bus"],
    ["walk", "--pd", "implicit"],
    ["walk", "--backend", "mujoco", "--realtime"],
    ["walk", "--priority", "10"],
    ["plot", "nowhere"],
    ["export", "nowhere"],
    ["compare", "nowhere", "nowhere"],
]


def stride(*arguments):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture
def walked(monkeypatch):
    """Let `stride walk` run on fakes; what it was asked for is collected."""
    asked = []

    def fake_build(request):
        asked.append(request)
        values = {name: getattr(request, name) for name in ("seed", "duration_s", "out", "report")}
        session = make_session(world=True, **values)
        fake_build.change(session)
        return session

    fake_build.change = id
    monkeypatch.setattr("hil.compose.build", fake_build)
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)  # slow, and drawn in other tests
    return asked, fake_build


@pytest.mark.parametrize("arguments", BAD_INPUT, ids=" ".join)
def test_bad_input_is_one_line_and_exit_2_and_leaves_nothing(arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = stride(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stderr.startswith("stride: ") and result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [["walk", "--rate", "fast"], ["walk", "--backend", "gazebo"], ["dance"]]
)
def test_what_the_command_line_cannot_parse_is_exit_2(arguments):
    assert stride(*arguments).exit_code == 2


def test_a_mistake_names_the_valid_choices():
    assert "minibiped" in stride("walk", "atlas").stderr
    assert "floor_friction" in stride("walk", "--set", "colour=red").stderr
    assert "V[@T]" in stride("walk", "--speed", "fast").stderr


def test_every_option_reaches_the_request(walked, tmp_path):
    asked, _ = walked
    result = stride(
        *("walk", "--backend", "mujoco", "--rate", "225", "--duration", "0.1", "--seed", "3"),
        *("--speed", "0.1", "--speed", "0.3@5", "--lateral", "0.05", "--turn", "90@2"),
        *("--step-width", "0.12", "--push", "0,3,0@4+0.3", "--estimator", "truth"),
        *("--water", "0.1", "--water", "0@8", "--density", "1100", "--viscosity", "2@3"),
        *("--no-ankle-limit", "--set", "mass_scale=1.1", "--out", str(tmp_path / "run")),
    )
    assert result.exit_code == 0, result.output
    (request,) = asked
    assert (request.backend, request.rate_hz, request.seed) == ("mujoco", 225, 3)
    assert request.schedules.speed == ((0.0, 0.1), (5.0, 0.3))
    assert request.schedules.water == ((0.0, 0.1), (8.0, 0.0))
    assert request.schedules.density == ((0.0, 1100.0),)
    assert request.schedules.viscosity == ((3.0, 2.0),)
    assert request.schedules.lateral == ((0.0, 0.05),)
    assert request.schedules.turns[0] == (2.0, pytest.approx(1.5708, abs=1e-4))
    assert request.schedules.step_width == 0.12
    assert request.schedules.pushes[0].force == (0.0, 3.0, 0.0)
    assert (request.estimator, request.ankle_limit) == ("truth", False)
    assert request.overrides == ("mass_scale=1.1",)


def test_the_run_folder_is_the_last_line(walked, tmp_path):
    folder = tmp_path / "run"
    result = stride("walk", "--duration", "0.5", "--out", str(folder))
    assert result.exit_code == 0
    assert result.stdout.splitlines()[-1] == str(folder)
    assert "mean speed" in result.stdout


def test_json_is_the_report_alone(walked, tmp_path):
    folder = tmp_path / "run"
    result = stride("walk", "--duration", "0.5", "--out", str(folder), "--json")
    assert json.loads(result.stdout) == json.loads((folder / "report.json").read_text())
    assert result.stderr.splitlines()[-1] == str(folder)


def test_a_fall_is_exit_1_with_its_report(walked, tmp_path):
    _, build = walked

    def lie_down(session):
        session.world.truth_now.base_orientation[:] = (0.7, 0.7, 0.0, 0.0)

    build.change = lie_down
    result = stride("walk", "--duration", "0.5", "--out", str(tmp_path / "run"))
    assert result.exit_code == 1
    assert "fell" in result.stdout
    assert result.stdout.splitlines()[-1] == str(tmp_path / "run")


@pytest.mark.parametrize(
    ("error", "code", "says"),
    [
        (BackendError("left_leg: port lost"), 1, "stride: left_leg: port lost"),
        (KeyboardInterrupt(), 130, "stride: interrupted"),
        (SystemExit(143), 143, ""),
    ],
    ids=["backend", "ctrl-c", "sigterm"],
)
def test_a_run_that_stops_has_its_own_exit_code(walked, tmp_path, error, code, says):
    _, build = walked

    def breaking(session):
        session.controller.raising = error

    build.change = breaking
    result = stride("walk", "--duration", "0.5", "--out", str(tmp_path / "run"))
    assert result.exit_code == code
    assert says in result.stderr
    if says:
        assert f"recorded in {tmp_path / 'run'}" in result.stderr
    assert (tmp_path / "run" / "report.json").is_file()


def test_the_real_command_reports_a_mistake_without_a_traceback():
    result = subprocess.run([*STRIDE, "walk", "atlas"], capture_output=True, text=True)
    assert result.returncode == 2
    assert result.stderr.startswith("stride: unknown robot 'atlas'")
    assert "Traceback" not in result.stderr


def test_help_teaches_with_examples():
    text = stride("walk", "--help").output
    assert "Examples" in text and "--push" in text and "V[@T]" in text
    commands = stride("--help").output
    for command in ("walk", "emulate", "compare", "plot", "export", "bench"):
        assert command in commands


def test_a_recording_can_be_exported_and_drawn_again(tmp_path, monkeypatch):
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)
    folder = tmp_path / "run"
    session = make_session(world=True, out=folder, duration_s=0.5)
    run(session, progress=False)
    rows = list(csv.DictReader(io.StringIO(stride("export", str(folder)).stdout)))
    assert len(rows) == 450 + 150 + 330  # start-up, walk, way down
    assert float(rows[-1]["time_s"]) == pytest.approx(479 / 300)
    assert float(rows[-331]["command.position.left_knee"]) == pytest.approx(0.1)
    assert "frame.foot_force.right.rear_left" in rows[0]
    file = tmp_path / "ticks.jsonl"
    assert stride("export", str(folder), "--format", "jsonl", "--out", str(file)).exit_code == 0
    ticks = [json.loads(line) for line in file.read_text().splitlines()]
    assert len(ticks) == 930
    assert ticks[0]["frame"]["joint_voltage"] == [None] * 12
    picture = tmp_path / "again.svg"
    assert stride("plot", str(folder), "--out", str(picture)).exit_code == 0
    assert picture.read_text().startswith("<?xml")
    assert stride("plot", str(folder), "--out", str(tmp_path / "x.doc")).exit_code == 2
