"""`stride check --description`: everything that a robot file lacks, each with its remedy."""

import json

import pytest
import yaml
from typer.testing import CliRunner

from hil.cli.main import app
from hil.description_gaps import description_gaps
from hil.robot_files import find_robot_file


@pytest.fixture
def edited(tmp_path):
    """A copy of minibiped's file with changes."""
    source = find_robot_file("minibiped")
    (tmp_path / "minibiped.xml").write_text(source.with_suffix(".xml").read_text())

    def edit(change):
        data = yaml.safe_load(source.read_text())
        change(data)
        file = tmp_path / "mine.yaml"
        file.write_text(yaml.safe_dump(data))
        return str(file)

    return edit


def knee(**changes):
    """A change of the left knee's lines."""
    return lambda data: data["joints"][3].update(**changes)


CHANGES = {
    "no servo": (knee(servo=None),
                 "joints.left_knee.servo", "dry run", "stride gains"),
    "no id": (knee(id=None), "joints.left_knee.id", "dry run", "scan"),
    "no bus": (knee(bus=None), "joints.left_knee.bus", "dry run", "buses"),
    "unknown servo": (knee(servo="XM999"),
                      "joints.left_knee.servo", "any walk", "XM430-W350"),
    "too strong": (knee(torque_limit=9.0),
                   "joints.left_knee.torque_limit", "any walk", "4.1 at most"),
    "too little damping": (knee(damping=0.1),
                           "joints.left_knee.damping", "any walk", "0.834"),
    "mode": (knee(servo="XL430-W250", mode="current"),
             "joints.left_knee.mode", "any walk", "position"),
    "sole": (lambda d: d["feet"]["left"].update(sole="pad"), "feet.left.sole", "any walk", "name"),
    "model": (lambda d: d.update(model="none.xml"), "model", "any walk", "MJCF"),
    "sit": (lambda d: d.pop("sit"), "sit", "real robot", "hoist"),
    "pose": (lambda d: d["start"]["joints"].update(left_knee=-1.0),
             "start.joints.left_knee", "any walk", "range"),
    "calibration": (lambda d: d.update(calibration="none.yaml"),
                    "calibration", "real robot", "stride calibrate"),
    "board": (lambda d: d["feet"]["left"].pop("board"),
              "feet.left.board", "any walk", "foot-board"),
    "imu": (lambda d: d.pop("imu"), "imu", "any walk", "IMU"),
    "missing key": (lambda d: d["noise"].pop("gyro"), "noise.gyro", "any walk", "write it"),
    "unknown key": (lambda d: d["supply"].update(volts=1), "supply.volts", "any walk", "remove"),
}  # fmt: skip


@pytest.mark.parametrize(("change", "where", "rung", "advice"), CHANGES.values(), ids=CHANGES)
def test_a_gap_names_its_key_its_rung_and_its_remedy(edited, change, where, rung, advice):
    (gap,) = [gap for gap in description_gaps(edited(change)) if gap.where == where]
    assert gap.needed_for == rung
    assert advice in gap.advice


def test_all_mistakes_are_told_at_once(edited):
    def change(data):
        data["noise"].pop("gyro")
        data["supply"]["volts"] = 12

    assert {gap.where for gap in description_gaps(edited(change))} == {"noise.gyro", "supply.volts"}


def test_minibiped_lacks_only_ports_and_calibration_and_human_nothing():
    rungs = {gap.needed_for for gap in description_gaps("minibiped")}
    assert rungs == {"real robot"}
    assert description_gaps("human") == []


def test_the_command_prints_a_table_and_exits_1(edited):
    file = edited(lambda data: data["joints"][3].update(servo=None))
    result = CliRunner().invoke(app, ["check", "--description", file])
    assert result.exit_code == 1
    assert "left_knee.servo" in result.stdout
    as_json = CliRunner().invoke(app, ["check", "--description", file, "--json"])
    assert json.loads(as_json.stdout)["gaps"][0]["where"] == "joints.left_knee.servo"
    assert CliRunner().invoke(app, ["check", "--description", "human"]).exit_code == 0
