"""The built wheel works from another folder: packages and robot files are all inside."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The wheel's content in a folder of its own."""
    out = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(out)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (wheel,) = out.glob("*.whl")
    site = out / "site"
    zipfile.ZipFile(wheel).extractall(site)
    return site


def test_only_our_packages_are_inside(installed):
    names = {path.name for path in installed.iterdir() if not path.name.endswith(".dist-info")}
    assert names == {"hil", "controller", "drivers", "sim_backends"}


def test_it_walks_from_another_folder(installed, tmp_path):
    environment = dict(os.environ, PYTHONPATH=str(installed))
    code = "import hil, sys; from hil.cli.main import main; print(hil.__file__); sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", code, "walk", "--duration", "2", "--out", "run"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(installed))
    report = json.loads((tmp_path / "run" / "report.json").read_text())
    assert report["robot"] == "minibiped"
    assert not report["fell"]
