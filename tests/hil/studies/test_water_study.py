"""`stride study water`: the grid, the row of a walk, and what is refused."""

import csv

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.request import RunRequest
from hil.studies.water import default_grid


def study(*arguments):
    return CliRunner().invoke(app, ["study", "water", *map(str, arguments)])


def test_a_quick_study_walks_on_land_and_in_water(tmp_path):
    out = tmp_path / "out"
    result = study("human", "--quick", "--jobs", 1, "--out", out)
    assert result.exit_code == 0, result.stderr
    with (out / "water.csv").open(newline="") as file:
        land, water = list(csv.DictReader(file))
    assert (float(land["level_m"]), float(water["level_m"])) == (0.0, 0.25)
    assert 4 <= int(land["steps"]) == pytest.approx(int(water["steps"]), abs=2)
    assert 0.08 < float(land["lift_m"]) < 0.2
    assert float(water["speed_mps"]) == pytest.approx(0.2, abs=0.05)
    assert (out / "water.png").read_bytes().startswith(b"\x89PNG")


def test_the_grid_of_the_human_is_that_of_the_seed_and_scales_with_the_leg():
    levels, speeds = default_grid(RunRequest(robot="human"))
    assert levels == (0.0, 0.25, 0.5, 0.75, 1.0)
    assert speeds == (0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
    small, slow = default_grid(RunRequest(robot="minibiped"))
    assert small[2] == pytest.approx(0.5 * 0.22 / 0.93, abs=0.01)
    assert slow[-1] < 0.4


def test_a_level_under_the_floor_is_refused(tmp_path):
    result = study("human", "--level", -1, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "levels" in result.stderr


def test_walks_go_sideways_in_water_and_are_hit(tmp_path):
    out = tmp_path / "out"
    grid = ("-s", 0.5, "-l", 0.25, "--lateral", 0.2, "--lateral", -0.2, "--duration", 8)
    result = study("human", *grid, "--ball", "5,5.4,0,0@3", "--jobs", 1, "--out", out)
    assert result.exit_code == 0, result.stderr
    with (out / "water.csv").open(newline="") as file:
        left, right = list(csv.DictReader(file))
    assert float(left["lateral_mps"]) == pytest.approx(0.2, abs=0.06)
    assert float(right["lateral_mps"]) == pytest.approx(-0.2, abs=0.06)


def test_a_ball_that_is_none_is_refused(tmp_path):
    result = study("human", "--ball", "heavy", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "--ball" in result.stderr
