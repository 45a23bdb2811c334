"""Shell completion as a shell asks for it: a script, commands, names of robots and files."""

import os
import subprocess
import sys
from pathlib import Path

import hil
from hil.cli.completion import robots

STRIDE = "from hil.cli.main import main; main()"


def stride(tmp_path, **environment):
    """Run the program as a shell's completion does, under its own name."""
    script = tmp_path / "bin" / "stride"
    script.parent.mkdir(exist_ok=True)
    script.write_text(f"#!{sys.executable}\n{STRIDE}\n")
    script.chmod(0o755)
    root = str(Path(hil.__file__).parents[1])
    done = subprocess.run(
        [str(script)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": root, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    return done.stdout


def completed(tmp_path, line):
    words = line.split(" ")
    return stride(
        tmp_path,
        _STRIDE_COMPLETE="complete_bash",
        COMP_WORDS=line,
        COMP_CWORD=str(len(words) - 1),
    ).split()


def test_the_script_of_a_shell_is_printed(tmp_path):
    script = stride(tmp_path, _STRIDE_COMPLETE="source_bash")
    assert "_STRIDE_COMPLETE" in script and "stride" in script


def test_commands_and_robots_are_offered(tmp_path):
    assert "doctor" in completed(tmp_path, "stride do")
    assert completed(tmp_path, "stride walk m") == ["minibiped"]


def test_robot_files_are_offered_folder_by_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").write_text("name: mine\n")
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "robot.yaml").write_text("name: robot\n")
    assert robots("m") == ["mine.yaml", "minibiped"]
    assert robots("r") == ["robot/"]
    assert robots("robot/") == ["robot/robot.yaml"]
