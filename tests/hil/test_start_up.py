"""What a command waits for before it does anything: the packages that its modules import."""

import subprocess
import sys

import pytest

HEAVY = ("cma", "matplotlib", "mujoco", "pandas", "scipy")


@pytest.mark.parametrize(
    ("module", "needed"),
    [
        ("hil.cli.main", set()),
        ("hil.recorder_process", set()),
        ("hil.compose", {"mujoco"}),
    ],
)
def test_only_what_is_needed_is_imported(module, needed):
    code = f"import {module}, sys; print(*({set(HEAVY)} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=60
    )
    assert set(done.stdout.split()) == needed
