"""A recording in the view: every tick, in order, at its pace."""

import numpy as np
import pytest
from typer.testing import CliRunner

from hil.after.shown import Showing, open_view, show_recording
from hil.cli.main import app
from hil.errors import InputError
from hil.plots.plotted_run import plotted_run
from hil.record_layout import tick_dtype


class FakeFeed:
    """Keeps what a view would be handed."""

    place = "somewhere"

    def __init__(self, job, rate_hz):
        self.job, self.rate_hz = job, rate_hz
        self.rows, self.told, self.closed = [], [], False

    def follow(self, last_row):
        self.last_row = last_row

    def put(self, record):
        self.rows.append(self.last_row().copy())
        self.told.append(self.facts()["faults"])

    def close(self):
        self.closed = True


@pytest.fixture
def feeds(monkeypatch):
    """Views that were opened, and a clock that a showing only moves by waiting."""
    made, now = [], [0]

    def opened(job, rate_hz):
        made.append(FakeFeed(job, rate_hz))
        return made[-1]

    def pause(seconds):
        now[0] += round(seconds * 1e9)

    monkeypatch.setattr("hil.after.shown.ViewFeed", opened)
    monkeypatch.setattr("hil.after.shown.stopwatch_ns", lambda: now[0])
    monkeypatch.setattr("hil.after.shown.pause", pause)
    return made, now


def test_every_tick_is_shown_as_it_was_recorded_at_its_pace(short_walk, feeds):
    (made, now), run = feeds, plotted_run(short_walk)
    run.report["faults"] = [{"time_s": 2.0, "source": "a", "name": "b", "reaction": "none"}]
    showing = Showing("web", slower=2.0, begin_s=1.5, times=2)
    show_recording(run, showing, open_view(run, showing))
    feed = made[0]
    assert (feed.job["joints"], feed.job["truth"], feed.job["steered"]) == (12, True, False)
    assert feed.job["overrides"] == ["plant.draws=null"]
    shown = np.array(feed.rows).view(tick_dtype(12, truth=True))[:, 0]
    expected = run.rows[run.time_s >= 1.5]
    assert len(shown) == 2 * len(expected)
    for topic, field in (("frame", "foot_force"), ("truth", "com"), ("status", "phase")):
        assert np.array_equal(shown[topic][field][: len(expected)], expected[topic][field])
    length_s = float(run.time_s[-1]) - 1.5
    assert now[0] * 1e-9 == pytest.approx(2 * 2.0 * length_s, rel=0.01)
    assert feed.told[0] == [] and len(feed.told[-1]) == 1


def test_a_beginning_behind_the_end_is_bad_input(short_walk, feeds):
    run = plotted_run(short_walk)
    showing = Showing("web", begin_s=99.0)
    with pytest.raises(InputError, match="--from 99"):
        show_recording(run, showing, open_view(run, showing))


def test_the_command_closes_the_view_after_ctrl_c(short_walk, feeds, monkeypatch):
    def interrupted(self, record):
        raise KeyboardInterrupt

    monkeypatch.setattr(FakeFeed, "put", interrupted)
    result = CliRunner().invoke(app, ["replay", str(short_walk), "--view", "web"])
    assert result.exit_code == 0
    assert "somewhere" in result.stderr
    assert feeds[0][0].closed
