"""What cannot be driven is refused in one line, and nothing is written."""

import pytest
from foreign_bipeds import Foreign
from typer.testing import CliRunner

from hil.cli.main import app

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
