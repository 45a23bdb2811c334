"""Every path of a layout is a number that is in the recording, every panel has a place."""

import json
import re

import numpy as np
from typer.testing import CliRunner

from hil.cli.main import app
from hil.recording import read_recording


def leaves(tree):
    """Panels of a layout tree."""
    if isinstance(tree, str):
        return [tree]
    assert tree["direction"] in ("row", "column") and 0 < tree["splitPercentage"] < 100
    return leaves(tree["first"]) + leaves(tree["second"])


def test_the_layout_shows_what_is_recorded(short_walk):
    result = CliRunner().invoke(app, ["export", str(short_walk), "--format", "foxglove"])
    assert result.exit_code == 0, result.output
    layout = json.loads(result.stdout)
    panels, tabs = layout["configById"], layout["configById"]["Tab!run"]["tabs"]
    assert layout["layout"] == "Tab!run"
    placed = [name for tab in tabs for name in leaves(tab["layout"])]
    assert sorted([*placed, "Tab!run"]) == sorted(panels)
    recording = read_recording(short_walk)
    values = {}
    for panel in panels.values():
        for series in panel.get("paths", ()):
            topic, field, index = re.fullmatch(
                r"/(\w+)\.(\w+)(?:\[(\d+)\])?", series["value"]
            ).groups()
            column = recording.rows[topic][field].reshape(len(recording.rows), -1)
            values[series["label"], panel.get("title")] = column[:, int(index or 0)]
            assert series["enabled"] and series["timestampMethod"] == "receiveTime"
    knee = recording.meta["joints"].index("right_knee")
    measured = recording.rows["frame"]["joint_position"][:, knee]
    assert np.array_equal(values["right knee", "Position: knee"], measured)
    corner = recording.rows["frame"]["foot_force"][:, 1, 2]
    assert np.array_equal(values["rear left", "Right foot, corner forces [N]"], corner)
