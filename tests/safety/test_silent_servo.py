"""`stride walk --fault servo:left_knee:silent@T+DT`, as a user types it: what is told, and how."""

import json

import pytest
from typer.testing import CliRunner

from hil.cli.main import app


def walk(tmp_path, lasting):
    words = ["walk", "--duration", "1.2", "--set", "plant.draws=null", "--out", str(tmp_path / "r"),
             "--fault", f"servo:left_knee:silent@0.5+{lasting}"]  # fmt: skip
    result = CliRunner().invoke(app, words)
    report = json.loads((tmp_path / "r" / "report.json").read_text())
    return result, [(f["source"], f["name"], f["reaction"]) for f in report["faults"]]


def test_ten_milliseconds_of_silence_are_walked_over(tmp_path):
    result, faults = walk(tmp_path, "0.01")
    assert result.exit_code == 0
    assert faults == [("servo:left_knee", "injected silent", "none")]


@pytest.mark.parametrize("lasting", ["0.1", "0.5"])
def test_a_tenth_of_a_second_ends_the_walk_by_name_with_torque_off(tmp_path, lasting):
    result, faults = walk(tmp_path, lasting)
    assert result.exit_code == 1
    assert faults[:2] == [
        ("servo:left_knee", "injected silent", "none"),
        ("left_knee", "silent", "soft_stop"),
    ]
    assert "left_knee" in result.output
    # Torque off was read back: otherwise the command would tell to cut the power by hand.
    assert "cut the servo power" not in result.output
