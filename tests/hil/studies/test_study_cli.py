"""Studies as a user starts them: quick ones end to end, bad input, other folders."""

import csv
import json

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.request import RunRequest
from hil.studies.pushes import PushCase, push_ladder
from hil.studies.speeds import SpeedCase, reach_speed

BAD_INPUT = [
    (["pushes", "human", "--direction", "up"], "back_left"),
    (["pushes", "human", "--force-step", "200", "--force-max", "100"], "--force-step"),
    (["pushes", "human", "--duration-after", "-1"], "follow_s"),
    (["pushes", "atlas"], "minibiped"),
    (["pushes", "human", "--jobs", "0"], "--jobs"),
    (["turns", "human", "--angle", "0"], "a turn by 0"),
    (["turns", "human", "--pd", "magic"], "--pd"),
    (["rates", "human", "--scenario", "dance"], "straight"),
    (["speeds", "minibiped", "--pd", "implicit"], "--pd"),
    (["speeds", "human", "--set", "colour=red"], "colour"),
    (["stabilizer", "human", "--solver", "magic"], "linear"),
    (["stabilizer", "minibiped"], "torque robots"),
]


def study(*arguments):
    return CliRunner().invoke(app, ["study", *map(str, arguments)])


@pytest.mark.parametrize(("arguments", "named"), BAD_INPUT, ids=lambda part: " ".join(part))
def test_bad_input_is_told_before_anything_runs(arguments, named, tmp_path):
    result = study(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and named in result.stderr
    assert not (tmp_path / "out" / "cases.jsonl").exists() or "--jobs" in arguments


def test_a_quick_study_prints_its_table_and_leaves_csv_and_figure(tmp_path):
    out = tmp_path / "out"
    result = study("pushes", "human", "--quick", "--jobs", 1, "--out", out)
    assert result.exit_code == 0, result.stderr
    assert "Δv/√(gL)" in result.stdout and "forward" in result.stdout
    assert result.stdout.splitlines()[-1] == str(out)
    with (out / "pushes.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["phase"] for row in rows] == ["0.0", "1.0"]
    assert {float(row["survived_n"]) for row in rows} == {50.0}
    assert float(rows[1]["start_s"]) > float(rows[0]["start_s"]) > 1.5
    assert (out / "pushes.png").read_bytes().startswith(b"\x89PNG")
    again = study("speeds", "human", "--quick", "--out", out)
    assert again.exit_code == 2
    assert again.stderr.count("\n") == 1 and "holds the study pushes of human" in again.stderr


def test_a_finished_study_is_printed_as_json_without_a_walk(tmp_path):
    out = tmp_path / "out"
    arguments = ("turns", "human", "--quick", "--angle", "30", "--out", out, "--json", "--jobs", 1)
    first, second = study(*arguments), study(*arguments)
    assert first.exit_code == 0, first.stderr
    data = json.loads(second.stdout)
    assert data == json.loads(first.stdout)
    (row,) = data["rows"]
    assert row["stopped_s"] is None and abs(row["final_error_deg"]) < 5
    assert "cases" not in second.stderr


def human(**values):
    return RunRequest(
        robot="human", backend="mujoco", rate_hz=300, estimator="truth", pd="explicit",
        stabilizer=False, ankle_limit=True, **values,
    )  # fmt: skip


def test_a_push_that_fells_ends_the_ladder():
    case = PushCase(
        request=human(),
        direction=(0.0, 1.0),
        start_s=1.0,
        duration_s=0.3,
        follow_s=1.5,
        forces=(40.0, 900.0, 1000.0),
    )
    assert push_ladder(case) == {"survived_n": 40.0, "fell_at_n": 900.0}


def test_a_fall_is_a_result():
    request = human(duration_s=2.0, overrides=("gain_rate=225",)).model_copy(update={"rate_hz": 40})
    result = reach_speed(SpeedCase(request=request, sagittal=0.5, coronal=0.0))
    assert result["ending"] == "fell" and result["stopped_s"] < 2.0
    assert result["speed_mps"] is None


def test_walk_as_long_as_its_steps():
    case = SpeedCase(request=human(duration_s=1.0), sagittal=0.5, coronal=0.0, steps=20)
    result = reach_speed(case)
    assert result["ending"] is None
    assert 20 <= result["steps"] <= 22
