"""A film of a recorded run: as long as it should be, of what was asked, whole or not at all."""

import sys

import numpy as np
import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.cli.video import picture_size
from hil.errors import InputError
from hil.film import film
from hil.film.encoder import Encoder
from hil.film.film import FilmPlan, film_run, film_ticks
from hil.film.offscreen import gl_platform
from hil.plots.plotted_run import plotted_run

av = pytest.importorskip("av", reason="the extra `video` is not installed")
SMALL = (64, 48)


@pytest.fixture(scope="module")
def run(short_walk):
    return plotted_run(short_walk)


def needs_gl():
    try:
        gl_platform()
    except InputError as error:
        pytest.skip(str(error))


def frames(path):
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)], stream


def test_a_film_has_the_pictures_of_its_time(run, tmp_path):
    needs_gl()
    told = []
    plan = FilmPlan(160, 120, 10.0, slower=2.0, begin_s=1.0, end_s=1.4)
    film_run(run, plan, tmp_path / "film.mp4", lambda *count: told.append(count))
    pictures, stream = frames(tmp_path / "film.mp4")
    assert len(pictures) == 8 and told[-1] == (8, 8)
    assert pictures[0].shape == (120, 160, 3)
    assert float(stream.average_rate) == 10.0
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]
    middle = [picture[30:100, 50:110].astype(float) for picture in pictures]
    assert np.std(middle[0]) > 10  # a robot, not an empty floor
    assert np.abs(middle[-1] - middle[0]).max() > 20  # that moves


def test_forces_are_seen_in_the_picture(run, tmp_path, monkeypatch):
    needs_gl()
    seen = []
    add = Encoder.add

    def keep(self, pixels):
        seen.append(pixels.copy())
        add(self, pixels)

    monkeypatch.setattr(Encoder, "add", keep)
    plan = FilmPlan(160, 120, 10.0, begin_s=1.0, end_s=1.05)
    film_run(run, plan, tmp_path / "a.mp4", lambda *_: None)
    monkeypatch.setattr("hil.film.film.Overlay.draw", lambda *_: None)
    film_run(run, plan, tmp_path / "b.mp4", lambda *_: None)
    assert np.abs(seen[0].astype(int) - seen[1]).max() > 50


def test_ticks_follow_the_runs_clock(run):
    plan = FilmPlan(*SMALL, 30.0)
    ticks = film_ticks(run, plan)
    times = run.time_s[ticks]
    assert times[0] == pytest.approx(-1.0, abs=0.004)
    assert np.diff(times) == pytest.approx(1 / 30, abs=0.004)
    assert len(film_ticks(run, FilmPlan(*SMALL, 30.0, slower=4.0))) == pytest.approx(
        4 * len(ticks), abs=3
    )
    with pytest.raises(InputError, match=r"nothing to show from 50 to"):
        film_ticks(run, FilmPlan(*SMALL, 30.0, begin_s=50.0))


def test_what_is_broken_off_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt), Encoder(tmp_path / "a.mp4", *SMALL, 30.0) as encoder:
        encoder.add(np.zeros((48, 64, 3), np.uint8))
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("way", ["glx", "glfw"])
def test_a_way_that_needs_a_display_is_refused_in_one_line(short_walk, tmp_path, monkeypatch, way):
    monkeypatch.setenv("MUJOCO_GL", way)
    result = CliRunner().invoke(app, ["video", str(short_walk), "--out", str(tmp_path / "a.mp4")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and "valid: egl, osmesa" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_computer_without_gl_is_told_what_to_install(short_walk, tmp_path, monkeypatch):
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr("ctypes.util.find_library", lambda _: None)
    result = CliRunner().invoke(app, ["video", str(short_walk), "--out", str(tmp_path / "a.mp4")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and "apt-get install libegl1" in result.stderr


def test_without_the_extra_the_command_says_so(short_walk, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    result = CliRunner().invoke(app, ["video", str(short_walk), "--out", str(tmp_path / "a.mp4")])
    assert result.exit_code == 2
    assert "pip install 'stridebridge[video]'" in result.stderr


@pytest.mark.parametrize("text", ["960", "961x540", "8x8", "axb", "-2x4"])
def test_a_wrong_size_is_bad_input(text):
    with pytest.raises(InputError, match="--size"):
        picture_size(text)


def test_a_robot_in_its_lamp_is_bright_wherever_it_walks(run):
    model = film.stage_model(run.description)
    film.light_up(model)
    assert model.vis.headlight.ambient.min() > 0.3
