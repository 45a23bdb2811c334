import sys
from pathlib import Path

import pytest

from hil.compose import build
from hil.request import RunRequest
from hil.run import run

# The fakes are shared by the tests of this folder only.
sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def short_walk(tmp_path_factory):
    """The folder of a walk of 3 s of the nominal small biped on MuJoCo; do not write into it."""
    folder = tmp_path_factory.mktemp("short") / "walk"
    request = RunRequest.checked(
        backend="mujoco", seed=1, duration_s=3.0, overrides=("plant.draws=null",), out=folder
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hil.run.draw_run", lambda *_: None)
        run(build(request), progress=False)
    return folder
