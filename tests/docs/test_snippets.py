"""What a page says to type is typed: blocks after `<!-- run -->`, and every line of Python."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
RUN = re.compile(r"^<!-- run -->\n```(\w+)\n(.*?)^```", re.DOTALL | re.MULTILINE)
PYTHON = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


def blocks_of(pattern):
    """Page and its blocks, for each page that has any."""
    found = [(page, pattern.findall(page.read_text(encoding="utf-8"))) for page in PAGES]
    return [pytest.param(blocks, id=page.name) for page, blocks in found if blocks]


@pytest.mark.parametrize("blocks", blocks_of(RUN))
def test_blocks_run_one_after_the_other(blocks, tmp_path):
    """In one folder, as a reader would; the programs are those of this environment."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    shells = {"sh": ["bash", "-euc"], "python": [sys.executable, "-c"]}
    for language, block in blocks:
        done = subprocess.run(
            [*shells[language], block],
            cwd=tmp_path,
            env=os.environ | {"PATH": path},
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"


@pytest.mark.parametrize("blocks", blocks_of(PYTHON))
def test_python_is_python(blocks):
    for block in blocks:
        compile(block, "page", "exec")


def test_the_quick_start_runs():
    assert any(one.id == "quick-start.md" for one in blocks_of(RUN))
