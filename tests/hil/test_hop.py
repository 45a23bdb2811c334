"""`stride jump minibiped` in the dry run, through the bus: it leaves the ground and stands."""

import json

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.interface import SIDES
from hil.jump_report import flight_of
from hil.recording import read_recording


def run(*arguments):
    asked = ["jump", "minibiped", "--target", 0, 0, 0, *arguments]
    return CliRunner().invoke(app, [*map(str, asked)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of the hop of the documentation."""
    out = tmp_path_factory.mktemp("hop") / "out"
    arguments = ("--airtime", 0.09, "--set", "supply.voltage=14.8", "--duration", 3.2)
    result = run(*arguments, "--out", out)
    assert result.exit_code == 0, result.output
    return out


def test_a_servo_robot_leaves_the_ground_and_stands(folder):
    report = json.loads((folder / "report.json").read_text())
    assert json.loads((folder / "meta.json").read_text())["rung"] == "dry run, jump"
    assert report["landed_standing"] and not report["fell"]
    assert report["airtime_s"] == pytest.approx(0.09, abs=0.015)
    assert 0.001 < report["foot_clearance_m"] < 0.01
    assert abs(report["apex_error_m"]) < 0.01 and report["landing_error_m"] < 0.05


def test_both_feet_are_unloaded_at_once_while_the_body_rises_and_falls(folder):
    trace = read_recording(folder).trace()
    begin, end = flight_of(trace)
    load = trace.foot_force[begin:end].sum(axis=2)
    assert load.shape[1] == len(SIDES) and load.max() < 0.3
    height = trace.com[:, 2]
    apex = begin + int(height[begin:end].argmax())
    assert height[apex] > height[begin] + 0.001 and height[apex] > height[end] + 0.005
    assert height[apex] - height[begin:apex].min() < 0.01


def test_a_hop_beyond_the_servos_is_refused_with_the_largest_that_they_do(tmp_path):
    out = tmp_path / "out"
    result = run("--airtime", 0.12, "--out", out)
    assert result.exit_code == 2 and not out.exists()
    assert "needs" in result.stderr and "the largest that fits" in result.stderr
    airtime = float(result.stderr.split("--airtime ")[1].split()[0])
    more = run("--airtime", 0.12, "--set", "supply.voltage=14.8", "--out", out)
    assert more.exit_code == 2
    assert float(more.stderr.split("--airtime ")[1].split()[0]) > airtime + 0.005 > 0.06


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--target", 0.1, 0, 0, "--airtime", 0.07], "on the spot"),
        (["--airtime", 0.07, "--push-depth", 0.2], "--push-depth: the knees bend for"),
    ],
    ids=["forward", "deep"],
)
def test_a_hop_that_is_none_is_refused(arguments, named):
    result = run(*arguments)
    assert result.exit_code == 2 and named in result.stderr
