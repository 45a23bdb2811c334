"""The documentation site, built once for all tests of it."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SITE = ROOT / "docs" / "site"


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """Folder of the built pages."""
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, str(SITE / "build.py"), str(out)]
    built = subprocess.run(command, cwd=out, capture_output=True, text=True, timeout=300)
    assert built.returncode == 0, built.stdout + built.stderr
    yield out / "html"
    shutil.rmtree(out)


@pytest.fixture
def site_tools(monkeypatch):
    """Makes the modules beside `docs/site/build.py` importable."""
    monkeypatch.syspath_prepend(str(SITE))
