"""`stride study robustness`: conditions, hidden draws, and a quick study end to end."""

import csv
import json
from math import radians

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from hil.cli.main import app
from hil.gait_report import flat_mid_stance
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.studies import hidden_draws
from hil.studies.conditions import CONDITIONS
from hil.studies.robust_tables import blame_table, conditions_table
from hil.studies.robust_walks import EMPTY
from hil.studies.robustness import RobustnessStudy
from hil.trace import TraceSink


def study(*arguments):
    return CliRunner().invoke(app, ["study", "robustness", *map(str, arguments)])


def test_every_condition_is_a_robot_that_can_be_built():
    for name, condition in CONDITIONS.items():
        description = load_robot("minibiped", condition.overrides)
        assert description.supply is not None, name
    assert load_robot("minibiped", CONDITIONS["low-battery"].overrides).supply.voltage == 10.5


def test_the_turn_adds_up_at_its_rate():
    turns = CONDITIONS["turn"].schedules.turns
    assert sum(angle for _, angle in turns) == pytest.approx(radians(115))
    assert turns[-1][0] - turns[0][0] == pytest.approx(radians(115), abs=0.05)


def test_draws_are_left_out_kept_alone_or_put_to_an_end():
    ranges = hidden_draws.drawn(load_robot("minibiped"))
    assert len(ranges) == 8

    def left(change):
        return hidden_draws.drawn(load_robot("minibiped", (change,)))

    assert set(left(hidden_draws.without(ranges, "backlash"))) == set(ranges) - {"backlash"}
    assert left(hidden_draws.only(ranges, "armature")) == {"armature": ranges["armature"]}
    nominal = load_robot("minibiped", hidden_draws.at_end("supply_resistance", 0.2))
    assert nominal.supply.resistance == 0.2 and nominal.plant.draws is None
    weak = load_robot("minibiped", hidden_draws.at_end("torque_constant_scale", 0.75))
    assert weak.plant.torque_constant_scale == 0.75
    assert load_robot("minibiped", hidden_draws.at_end("floor_height", -0.001))


def test_a_quick_study_leaves_its_table(tmp_path):
    out = tmp_path / "out"
    result = study(
        "--quick", "--backend", "mujoco", "-c", "baseline", "-c", "in-place", "--jobs", 1,
        "--out", out,
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    with (out / "robustness.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["condition"] for row in rows] == ["baseline", "in-place"]
    assert {row["survived"] for row in rows} == {"True"}
    assert all(row["loaded_joint"].split("_", 1)[1] in ("knee", "hip_pitch") for row in rows)
    assert all(25.0 <= float(row["temperature_max_c"]) < 40.0 for row in rows)
    assert all(5.0 < float(row["torque_rms_pct"]) < 60.0 for row in rows)
    assert (out / "robustness.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "named"), [(["-c", "moon"], "baseline"), (["human"], "servo robot")]
)
def test_bad_input_is_told_before_anything_runs(arguments, named, tmp_path):
    result = study(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and named in result.stderr


def fallen(case):
    """A walk that only a robot without backlash survives."""
    texts = [text for text in case.request.overrides if text.startswith("plant.draws=")]
    draws = yaml.safe_load(texts[-1].partition("=")[2]) if texts else {"backlash": 0}
    survived = "backlash" not in (draws or {})
    return {"survived": survived, "ending": None if survived else "fell", "stopped_s": 1.0}


def test_the_draw_that_fells_is_found():
    request = RunRequest(robot="minibiped", backend="mujoco", rate_hz=300)
    asked = RobustnessStudy(
        request=request, conditions=("baseline",), rates_hz=(300,), seeds=(0, 1), phases=1,
        longest_s=3.0, blame=True, ends=False,
    )  # fmt: skip

    def run_cases(function, cases):
        return [fallen(case) for case in cases]

    result = asked.conduct(run_cases)
    assert result.tables[0].rows[0][:3] == ("baseline", "300", "0/2")
    guilty = [line for line in result.tables[1].rows if line[2] == "2/2"]
    assert [line[1:] for line in guilty] == [("backlash", "2/2", "2/2")]
    assert result.tables[1].rows[0][1] == "backlash"


def test_a_table_names_the_worst_joint_and_counts_robots():
    rows = [
        EMPTY | {"condition": "baseline", "rate_hz": 300, "seed": seed, "survived": seed != 1,
                 "speed_error_pct": error, "flat_pct": 90.0, "saturation_pct": 10.0 + seed,
                 "saturated_joint": f"joint{seed}", "torque_rms_pct": 30.0,
                 "loaded_joint": "left_knee", "temperature_max_c": 40.0}
        for seed, error in ((0, 2.0), (1, None), (2, 4.0))
    ]  # fmt: skip
    (line,) = conditions_table("head", rows).rows
    assert line[2:7] == ("2/3", "3.0 %", "1.0 %", "90.0", "12 joint2")
    assert json.dumps(blame_table([]).rows) == "[]"


def test_mid_stance_counts_loaded_corners():
    sink = TraceSink(1, 40)
    trace = sink.trace()
    assert flat_mid_stance(trace, 10.0) is None
    columns = sink._columns
    columns["time_s"][:] = np.arange(40) * 0.05
    columns["steps"][:] = np.arange(40) // 10
    columns["phase"][:] = np.tile(np.arange(10) / 10, 4)
    columns["walking"][:] = True
    columns["foot_force"][:, 0] = 2.5
    columns["foot_force"][30:, 0, :2] = 0.1  # on the heel in the last step
    sink._rows = 40
    assert flat_mid_stance(sink.trace(), 10.0) == pytest.approx(50.0)
