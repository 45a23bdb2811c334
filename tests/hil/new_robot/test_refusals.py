"""What cannot be driven is refused in one line, and nothing is written."""

from pathlib import Path

import pytest
from foreign_bipeds import Foreign
from typer.testing import CliRunner

from hil.cli.main import app
from hil.robot_files import load_robot

LOOP = '<equality><connect body1="chest" body2="pelvis" anchor="0 0 0" name="bar"/></equality>'
SLIDE = (
    Foreign()
    .text()
    .replace('name="l_knee" axis="0 1 0"', 'name="l_knee" type="slide" axis="0 1 0"')
)
DIAGONAL = (
    Foreign().text().replace('name="l_hip_roll" axis="-1 0 0"', 'name="l_hip_roll" axis="1 0 1"')
)
FLAT = Foreign(waist=False).text().replace("0.0 0.04 0", "0 0 0").replace("0.0 -0.04 0", "0 0 0")

CASES = {
    "five joints": (Foreign(ankle_roll=False).text(), "no ankle_roll"),
    "four joints": (Foreign(ankle_roll=False, ankle_pitch=False).text(), "2 pitch joints"),
    "four legs": (Foreign(extra_legs=2).text(), "legs reach the ground"),
    "closed loop": (Foreign(after=LOOP).text(), "equality bar closes a loop"),
    "slide": (SLIDE, "l_knee of a leg is no hinge"),
    "between axes": (DIAGONAL, "l_hip_roll lies between"),
    "one plane": (FLAT, "one plane"),
    "point foot": (Foreign(foot='<geom type="sphere" size=".01" pos="0 0 -.03" mass=".1"/>').text(),
                   "stands on 0 x 0 mm"),
    "no limbs": (
        '<mujoco><worldbody><body><freejoint/><geom size="1"/></body></worldbody></mujoco>',
        "no legs found",
    ),
    "no XML": ("legs: 2", "is not XML"),
    "no known encoding": ('<?xml version="1.0" encoding="elvish"?><mujoco/>', "is not XML"),
    "another XML": ("<sdf/>", "neither MJCF"),
    "does not compile": ("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>",
                         "does not compile"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "says"), CASES.values(), ids=CASES.keys())
def test_a_refusal_is_one_line_and_writes_nothing(tmp_path, monkeypatch, text, says):
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "theirs.xml"
    source.write_text(text)
    result = CliRunner().invoke(app, ["new-robot", str(source)])
    assert result.exit_code == 2, result.output
    assert result.stderr.startswith("stride: ") and result.stderr.count("\n") == 1
    assert "theirs.xml" in result.stderr and says in result.stderr
    assert list(tmp_path.iterdir()) == [source]


def test_files_that_are_there_are_not_written_over(tmp_path):
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign().text())
    command = ["new-robot", str(source), "--name", "mine", "--out", str(tmp_path / "out")]
    assert CliRunner().invoke(app, command).exit_code == 0
    before = (tmp_path / "out" / "mine.yaml").read_text()
    again = CliRunner().invoke(app, command)
    assert again.exit_code == 2 and "exists" in again.stderr
    assert (tmp_path / "out" / "mine.yaml").read_text() == before


@pytest.mark.parametrize(
    "options", [["--name", "a/b"], ["--servo", "XM999"], ["--servo", "XM430-W350", "--similar"]]
)
def test_bad_options_are_refused(tmp_path, monkeypatch, options):
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign().text())
    result = CliRunner().invoke(app, ["new-robot", str(source), *options])
    assert result.exit_code == 2 and result.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == [source]


@pytest.mark.parametrize("name", ["123", "yes", "0x1", "null"])
def test_a_name_that_yaml_takes_for_something_else_stays_a_name(tmp_path, name):
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign().text())
    command = ["new-robot", str(source), "--name", name, "--out", str(tmp_path / "out")]
    assert CliRunner().invoke(app, command).exit_code == 0
    assert load_robot(str(tmp_path / "out" / f"{name}.yaml")).name == name


@pytest.mark.parametrize("where", ["theirs.xml", "theirs.xml/out"])
def test_a_folder_that_cannot_be_made_is_one_line(tmp_path, where):
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign().text())
    command = ["new-robot", str(source), "--name", "mine", "--out", str(tmp_path / where)]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 2 and result.stderr.count("\n") == 1
    assert source.is_file()


def test_a_disk_that_is_full_leaves_no_half_robot(tmp_path, monkeypatch):
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign().text())
    write = Path.write_text

    def full(path, text, **more):
        if path.suffix == ".xml":
            raise OSError(28, "No space left on device")
        return write(path, text, **more)

    monkeypatch.setattr(Path, "write_text", full)
    command = ["new-robot", str(source), "--name", "mine", "--out", str(tmp_path / "out")]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 2 and "No space left" in result.stderr
    assert list((tmp_path / "out").iterdir()) == []
