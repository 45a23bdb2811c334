"""report.html: whole in itself, and true to the run."""

import base64
import json
import shutil
from html.parser import HTMLParser

import pytest
from hil_fakes import make_session
from typer.testing import CliRunner

from hil.cli.main import app
from hil.plots.plotted_run import plotted_run
from hil.report_page import report_page, settings, verdict, write_report_page
from hil.run import run


class Page(HTMLParser):
    """Text, links and pictures of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.pictures, self.text, self.tags = [], [], "", []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            if name in ("src", "href"):
                (self.pictures if tag == "img" else self.links).append(value)

    def handle_data(self, data):
        self.text += data


@pytest.fixture(autouse=True)
def cheap_plots(monkeypatch, request):
    """Pictures are drawn in full by one test; for the others one pixel will do."""
    if "full" not in request.node.name:
        pixel = base64.b64decode(
            "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5"
            "ErkJggg=="
        )
        monkeypatch.setattr("hil.report_page.draw_plot", lambda *plot: plot[2].write(pixel))
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)


def test_the_full_page_needs_no_other_file_and_no_network(short_walk, tmp_path):
    folder = shutil.copytree(short_walk, tmp_path / "run")
    result = CliRunner().invoke(app, ["plot", str(folder), "--html"])
    assert result.exit_code == 0, result.output
    assert result.stdout.strip() == str(folder / "report.html")
    html = (folder / "report.html").read_text(encoding="utf-8")
    page = Page(html)
    assert len(page.pictures) == 9
    for picture in page.pictures:
        assert base64.b64decode(picture.removeprefix("data:image/png;base64,"))[:4] == b"\x89PNG"
    outside = [link for link in page.links if not link.startswith(("#", "data:"))]
    assert outside == ["report.json", "meta.json", "session.mcap"]
    assert all((folder / link).is_file() for link in outside)
    assert "script" not in page.tags and "http" not in html
    targets = {link[1:] for link in page.links if link.startswith("#")}
    assert all(f'id="{target}"' in html for target in targets)
    report = json.loads((folder / "report.json").read_text())
    assert f"{report['mean_speed_mps']:.3f}" in page.text
    assert "went to its end" in page.text
    assert "plant.draws=null" in page.text
    assert html.count("<svg") == 0 and len(html) < 3_000_000


def test_faults_are_listed_and_nothing_in_them_is_markup(short_walk, tmp_path):
    folder = shutil.copytree(short_walk, tmp_path / "run")
    report = json.loads((folder / "report.json").read_text())
    report["faults"] = [
        {"time_s": 1.0, "source": "left_knee", "name": "<b>silent</b>", "reaction": "none"},
        {"time_s": 2.5, "source": "body", "name": "fell", "reaction": "torque_off"},
    ]
    (folder / "report.json").write_text(json.dumps(report))
    fallen = plotted_run(folder)
    html = report_page(fallen, [])
    assert "&lt;b&gt;silent" in html and "<b>silent" not in html
    assert verdict(fallen) == (False, "body: fell at 2.50 s")
    assert '<span class="badge">body: fell at 2.50 s</span>' in html


def test_a_run_that_was_killed_has_a_page_of_what_was_recorded(short_walk, tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    data = (short_walk / "session.mcap").read_bytes()
    (folder / "session.mcap").write_bytes(data[: 2 * len(data) // 3])
    killed = plotted_run(folder)
    assert verdict(killed) == (False, "ended without a report, and the recording is cut off")
    write_report_page(folder, killed, folder / "page.html")
    page = Page((folder / "page.html").read_text())
    assert "before it could say" in page.text
    assert "distance_m" in page.text
    assert [link for link in page.links if not link.startswith(("#", "data:"))] == ["session.mcap"]


def test_a_run_without_a_walk_has_a_page_too(tmp_path):
    run(make_session(world=True, out=tmp_path / "fake", duration_s=0.5), progress=False)
    stood = plotted_run(tmp_path / "fake")
    stood.rows["safety"]["walking"] = False
    page = Page(report_page(stood, []))
    assert len(page.pictures) == 2  # nothing to be said of a walk, nor of servos
    stood.recording.meta["rung"] = "dry run, stand"
    assert "mean speed" not in Page(report_page(stood, [])).text


def test_settings_leave_out_what_was_left_open():
    request = {"robot": "minibiped", "live": False, "pd": None, "schedules": {"speed": [[0, 0.2]],
               "turns": []}, "seed": 0}  # fmt: skip
    assert settings(request) == {
        "robot": "minibiped",
        "schedules.speed": "0, 0.2",
        "seed": "0",
    }
