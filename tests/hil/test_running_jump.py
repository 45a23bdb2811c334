"""`stride jump --run-up`: a walk, a jump out of it, and a walk again."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from controller.jumping.jump_controller import carried_share
from hil.cli.main import app
from hil.jump_report import flight_of
from hil.recording import read_recording


def run(*arguments):
    return CliRunner().invoke(app, ["jump", *map(str, arguments)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """To the left and forward out of a walk of 0.5 m/s, and on for 3.5 s."""
    out = tmp_path_factory.mktemp("running") / "out"
    target = ("--target", 0.3, 0.1, 0, "--airtime", 0.35)
    result = run("--run-up", 0.5, *target, "--duration", 11.5, "--out", out)
    assert result.exit_code == 0, result.output
    return out


def test_it_lands_on_its_target_standing_and_walks_on(folder):
    report = json.loads((folder / "report.json").read_text())
    assert report["landed_standing"] and not report["fell"]
    assert report["landing_error_m"] < 0.03
    trace = read_recording(folder).trace()
    before = trace.com_velocity[(trace.time_s > 1.5) & (trace.time_s < 3.0), 0]
    after = trace.com_velocity[-300:, 0]
    assert before.mean() == pytest.approx(0.5, abs=0.05)
    assert after.mean() > 0.25
    begin, end = flight_of(trace)
    assert 3.5 < trace.time_s[begin] < 6.0
    assert trace.com[-1, 0] > trace.com[end, 0] + 0.3
    assert (folder / "picture.png").exists()


def test_it_does_not_stop_before_it_jumps(folder):
    """The walk hands over while the body still goes forward."""
    trace = read_recording(folder).trace()
    begin, _ = flight_of(trace)
    down = int(np.argmin(trace.com[:begin, 2]))
    walking = np.flatnonzero(trace.phase[:down] > 0.0)[-1]
    assert trace.com_velocity[walking + 1, 0] > 0.05


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--run-up", 0.5, "--target", 0.3, 0, 0.15), "level ground"),
        (("minibiped", "--run-up", 0.1, "--target", 0, 0, 0), "from a stand"),
        (("--run-up", 0.5, "--gravity", 1.62), "gravity"),
        (("--run-up", 0), "--run-up"),
    ],
)
def test_a_run_up_that_cannot_be_is_refused(arguments, named):
    result = run(*arguments)
    assert result.exit_code == 2
    assert named in str(result.exception) + result.output


lengths = st.floats(-0.3, 0.3)


@given(lengths, lengths, st.floats(-0.5, 1.0), st.floats(0.3, 2.0))
def test_a_crouch_keeps_a_part_of_the_speed_and_never_more(still, moving, speed, time):
    share = carried_share(still, moving, speed, time)
    assert 0.0 <= share <= 1.0


@given(st.floats(0.05, 0.2), st.floats(0.0, 0.1), st.floats(0.1, 0.4))
def test_the_share_ends_the_way_with_least_effort(still, nearer, speed):
    """A cubic that ends without acceleration, checked by its own coefficients."""
    time, moving = 0.8, still - nearer
    share = carried_share(still, moving, speed, time)
    if 0.0 < share < 1.0:
        way, end = still + share * (moving - still), share * speed
        square, cube = np.linalg.solve(
            [[time**2, time**3], [2 * time, 3 * time**2]], [way - speed * time, end - speed]
        )
        assert 2 * square + 6 * cube * time == pytest.approx(0.0, abs=1e-9)
