"""`stride study gait`: a small search end to end, what it leaves behind, bad input."""

import csv
import shutil

import pytest
import yaml
from typer.testing import CliRunner

from hil.cli.main import app
from hil.robot_facts import robot_facts
from hil.robot_files import find_robot_file, load_robot
from hil.studies.gait_walks import growing_pushes

BAD_INPUT = [
    (["minibiped", "--space", "poses"], "no key poses"),
    (["human", "--space", "gains"], "torque robots: study gains"),
    (["human", "--space", "gait"], "--vary"),
    (["minibiped", "--space", "dance"], "space"),
    (["minibiped", "--space", "gains", "--vary", "elbow.kp"], "elbow.kp"),
    (["minibiped", "--weight", "beauty=1"], "energy"),
    (["human", "--weighting", "3-3-3"], "3-6-1"),
    (["minibiped", "--space", "style"], "no key poses"),
    (["minibiped", "--weight", "energy=much"], "NAME=NUMBER"),
]


def study(*arguments):
    return CliRunner().invoke(app, ["study", "gait", *map(str, arguments)])


@pytest.mark.parametrize(("arguments", "named"), BAD_INPUT, ids=lambda part: " ".join(part))
def test_bad_input_is_told_before_anything_runs(arguments, named, tmp_path):
    result = study(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and named in result.stderr


def search(out, jobs):
    return study(
        "minibiped", "--backend", "mujoco", "--space", "gains", "--vary", "knee.kp", "--quick",
        "--jobs", jobs, "--out", out,
    )  # fmt: skip


@pytest.fixture(scope="module")
def searched(tmp_path_factory):
    """A quick search, and its folder."""
    out = tmp_path_factory.mktemp("search") / "out"
    return search(out, 1), out


def test_a_quick_search_leaves_values_that_a_robot_file_takes(searched, tmp_path):
    result, out = searched
    assert result.exit_code == 0, result.stderr
    assert "energy" in result.stdout and "knee" in result.stdout
    with (out / "gait.csv").open(newline="") as file:
        costs = [float(row["best_cost"]) for row in csv.DictReader(file)]
    assert len(costs) == 2 and costs[1] <= costs[0]
    assert (out / "gait.png").read_bytes().startswith(b"\x89PNG")
    best = yaml.safe_load((out / "best.yaml").read_text(encoding="utf-8"))
    assert set(best) == {"gains"} and set(best["gains"]) == {300}
    data = yaml.safe_load(find_robot_file("minibiped").read_text(encoding="utf-8"))
    for rate, gains in best["gains"].items():
        data["gains"][rate].update(gains)
    data["model"] = str(load_robot("minibiped").model_path)
    file = tmp_path / "robot.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    assert load_robot(str(file)).gains[300]["knee"][0] == best["gains"][300]["knee"][0]


def test_a_search_cut_short_goes_on_and_finds_the_same(searched, tmp_path):
    _, whole = searched
    out = shutil.copytree(whole, tmp_path / "out")
    lines = (whole / "cases.jsonl").read_bytes().splitlines(keepends=True)
    torn = b"".join(lines[: len(lines) // 2]) + lines[len(lines) // 2][:20]
    (out / "cases.jsonl").write_bytes(torn)
    for name in ("best.yaml", "gait.csv"):
        (out / name).unlink()
    result = search(out, 2)
    assert result.exit_code == 0, result.stderr
    for name in ("best.yaml", "gait.csv"):
        assert (out / name).read_bytes() == (whole / name).read_bytes()
    assert len((out / "cases.jsonl").read_bytes().splitlines()) == len(lines)


def test_a_quick_search_for_a_style_leaves_an_entry_of_styles(tmp_path):
    out = tmp_path / "out"
    result = study(
        "human", "--space", "style", "--level", 0.5, "--speed", 0.3, "--quick", "--jobs", 1,
        "--out", out,
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    assert "drag" in result.stdout and "swing_aside[0]" in result.stdout
    [style] = yaml.safe_load((out / "best.yaml").read_text(encoding="utf-8"))
    assert (style["speed"], style["water"]) == (0.3, 0.5)
    assert {name: len(knots) for name, knots in style["poses"].items()} == {
        "root_pitch": 3, "back_pitch": 2, "stance_foot": 11, "swing_foot": 11, "stance_knee": 5,
        "swing_aside": 3, "swing_drop": 5, "swing_ahead": 11,
    }  # fmt: skip
    with (out / "style.csv").open(newline="") as file:
        costs = [float(row["best_cost"]) for row in csv.DictReader(file)]
    assert costs[1] <= costs[0] < 12.0


def test_pushes_grow_and_go_around():
    facts = robot_facts(load_robot("minibiped"))
    pushes = growing_pushes(facts, 4.0, 5)
    sizes = [abs(push.force[0]) + abs(push.force[1]) for push in pushes]
    assert sizes == sorted(sizes) and sizes[0] < sizes[-1]
    assert pushes[0].start == 4.0 and pushes[1].start > pushes[0].start + pushes[0].duration
    directions = [tuple((one > 0) - (one < 0) for one in push.force[:2]) for push in pushes]
    assert directions == [(0, 1), (1, 0), (0, -1), (-1, 0), (0, 1)]
