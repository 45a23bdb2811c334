import json

import numpy as np
import pytest
from hil_fakes import make_session
from hil_walks import walk
from typer.testing import CliRunner

from hil.cli.main import app
from hil.compare import STRIDE_BINS, Walk, compare_walks, joint_rms_difference, stride_profile
from hil.recording import read_recording
from hil.run import run

META = {"weight_n": 100.0, "joints": [f"j{i}" for i in range(12)], "rung": "simulation"}


def test_a_profile_is_the_same_for_walks_of_different_step_times():
    slow, fast = walk(20.0), walk(20.0, step_time=0.25)
    profiles = [stride_profile(trace, np.sin(trace.phase)) for trace in (slow, fast)]
    assert profiles[0].shape == (STRIDE_BINS,)
    assert np.nanmax(np.abs(profiles[0] - profiles[1])) < 0.03


def test_the_rms_of_a_known_difference():
    one, other = walk(20.0), walk(20.0)
    other.joint_position[:, 3] += 0.12
    a, b = Walk("a", META, one), Walk("b", META, other)
    assert joint_rms_difference(a, b) == pytest.approx(0.12 / np.sqrt(12))
    assert joint_rms_difference(a, Walk("c", {**META, "joints": ["other"]}, other)) is None


def test_figures_stand_side_by_side():
    a, b = Walk("a", META, walk(20.0)), Walk("b", META, walk(20.0, step_time=0.25))
    figures = {figure.key: figure for figure in compare_walks(a, b)}
    assert (figures["steps"].first, figures["steps"].second) == (39, 79)
    assert figures["steps"].difference_pct == pytest.approx(100 * 40 / 39)
    assert figures["step_time_s"].first == pytest.approx(19.99 / 39)
    assert figures["foot_load_mean_n"].first == pytest.approx(100.0)


def test_the_command_prints_json_and_draws(tmp_path, monkeypatch):
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)
    for name, seed in (("a", 1), ("b", 2)):
        run(
            make_session(world=True, out=tmp_path / name, seed=seed, duration_s=2.0), progress=False
        )
    folders = [str(tmp_path / name) for name in ("a", "b")]
    result = CliRunner().invoke(app, ["compare", *folders, "--json"])
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)
    assert figures["steps"]["difference"] == 0
    assert figures["joint_rms_difference_rad"]["difference"] == pytest.approx(0.0)
    assert (tmp_path / "b" / "compare-a.png").read_bytes().startswith(b"\x89PNG")
    monkeypatch.setattr("hil.figures_compare.draw_comparison", lambda *_: None)
    read = []

    def counted(folder):
        read.append(folder.name)
        return read_recording(folder)

    monkeypatch.setattr("hil.recording.read_recording", counted)
    table = CliRunner().invoke(app, ["compare", *folders])
    assert "mean_speed_mps" in table.output
    assert read == ["a", "b"]  # a recording of ten minutes takes its time to read
