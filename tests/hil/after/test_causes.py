"""Walks in which one known thing was changed: it must be named first, and nothing named without."""

import json

import pytest
from typer.testing import CliRunner

from hil.after.comparison import NOTHING, compare_runs
from hil.after.recorded import read_run
from hil.cli.main import app


@pytest.mark.parametrize(
    ("change", "cause", "joint", "difference"),
    [
        ("plant.joint_friction={left_knee: 0.3}", "friction", "left_knee", 0.2),
        ("plant.torque_constant_scale={right_hip_pitch: 0.75}", "gain", "right_hip_pitch", -25),
        ("plant.joint_zero={left_knee: 0.03}", "zero", "left_knee", 1.7),
        ("plant.latency_ticks=1", "delay", None, 3.33),
        ("supply.voltage=10.5", "battery", None, -1.5),
    ],
)
def test_what_was_changed_is_named_first(walked, change, cause, joint, difference):
    found = compare_runs(read_run(walked()), read_run(walked(change)))
    first = found.findings[0]
    assert (first.cause, first.joint) == (cause, joint), [str(one) for one in found.findings]
    assert first.difference == pytest.approx(difference, rel=0.25)
    if joint is not None:
        assert found.rows[0].joint == joint


def test_another_walk_of_the_same_robot_shows_nothing(walked):
    found = compare_runs(read_run(walked()), read_run(walked("noise.corner_force=0.33")))
    assert [str(one) for one in found.findings] == []
    assert found.verdict == NOTHING
    assert max(row.torque_rms for row in found.rows) > 0.0


def test_a_run_is_as_itself(walked):
    found = compare_runs(read_run(walked()), read_run(walked()))
    assert found.verdict == NOTHING
    assert max(row.position_rms for row in found.rows) == 0.0


def test_the_command_names_the_cause_and_draws_the_joints(walked, tmp_path):
    change = "plant.joint_friction={left_knee: 0.3}"
    folders = [str(walked()), str(walked(change))]
    arguments = ["compare", *folders, "--out", str(tmp_path / "both.png")]
    text = CliRunner().invoke(app, arguments)
    assert text.exit_code == 0, text.output
    assert "left_knee: friction" in text.output
    assert "mean_speed_mps" in text.output
    for name in ("both.png", "both-joints.png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    data = json.loads(CliRunner().invoke(app, [*arguments, "--json"]).stdout)
    assert data["comparison"]["joints"][0]["cause"] == "friction"
    assert data["comparison"]["causes"][0]["unit"] == "N·m"
    assert data["no_causes_because"] is None
