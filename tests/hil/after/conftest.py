import pytest

from hil.compose import build
from hil.request import RunRequest
from hil.run import run


@pytest.fixture(scope="session")
def walked(tmp_path_factory):
    """Make walks of the nominal small biped on MuJoCo; each is made once."""
    home, made = tmp_path_factory.mktemp("walks"), {}

    def make(*changes):
        if changes not in made:
            folder = home / f"walk{len(made)}"
            request = RunRequest.checked(
                backend="mujoco",
                seed=1,
                duration_s=6.0,
                overrides=("plant.draws=null", *changes),
                out=folder,
            )
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr("hil.run.draw_run", lambda *_: None)
                run(build(request), progress=False)
            made[changes] = folder
        return made[changes]

    return make
