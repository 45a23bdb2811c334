"""What the plots of a run say, on walks whose every number is known."""

import shutil

import numpy as np
import pytest
from hil_walks import WEIGHT, walk
from matplotlib.figure import Figure
from typer.testing import CliRunner

from hil.cli.main import app
from hil.export import write_mcap
from hil.figures import draw_strip
from hil.interface import Limit
from hil.plots.catalogue import PLOTS, draw_plot
from hil.plots.gait import support_shares
from hil.plots.joints import tracking_errors
from hil.plots.plotted_run import PlottedRun, plotted_run
from hil.plots.pressure import side_shares
from hil.plots.supervision import limit_shares
from hil.plots.water import is_wet
from hil.recording import Recording, read_recording
from hil.robot_files import load_robot


@pytest.fixture(scope="module")
def run(short_walk):
    return plotted_run(short_walk)


def edited(run, edit, report=None):
    rows = run.rows.copy()
    edit(rows)
    return PlottedRun("edited", Recording(run.meta, rows, True), run.description, report)


def stride(*arguments):
    return CliRunner().invoke(app, list(map(str, arguments)))


def test_shares_of_support_are_of_feet_that_carry():
    forces = np.zeros((400, 2, 4))
    forces[:100] = WEIGHT / 8  # both
    forces[100:300, 1] = WEIGHT / 4
    forces[300:, 0] = 0.01 * WEIGHT  # touches, does not carry
    trace = walk(4.0, foot_force=forces)
    assert support_shares(trace, WEIGHT) == "Support: both feet 25 %, one 50 %, none 25 %"


def test_shares_of_the_sides_are_the_seeds_measure():
    forces = np.zeros((100, 2, 4))
    forces[:, 0] = (30.0, 10.0, 20.0, 20.0)  # front left and right, rear left and right
    trace = walk(1.0, step_time=9.0, foot_force=forces, toe_force=np.full((100, 2), 20.0))
    left, right, front, rear = side_shares(trace)[0]
    assert (left, right) == (50 / 80, 30 / 80)  # without the toe
    assert (front, rear) == (60 / 100, 40 / 100)  # with it
    assert np.isnan(side_shares(walk(1.0, foot_force=0 * forces))).all()


def test_tracking_errors_are_of_the_targets_that_were_sent(run):
    def edit(rows):
        rows["applied"]["position"] = rows["frame"]["joint_position"]
        rows["applied"]["position"][:, 3] += np.radians(2.0)
        rows["applied"]["position"][::2, 4] += np.radians(9.0)
        rows["applied"]["limit"][::2, 4] |= int(Limit.HELD)  # was not sent
        rows["applied"]["stiffness"][:, 5] = 0.0

    errors = tracking_errors(edited(run, edit))
    assert errors[3] == pytest.approx(2.0)
    assert np.abs(errors[[0, 1, 2, 4]]).max() < 1e-9
    assert np.isnan(errors[5])


def test_limits_count_walking_ticks_only(run):
    def edit(rows):
        rows["applied"]["limit"] = 0
        walking = np.flatnonzero(rows["safety"]["walking"] & (rows["time_s"] >= 0))
        rows["applied"]["limit"][walking[: len(walking) // 4], 7] = Limit.TORQUE | Limit.POSITION
        rows["applied"]["limit"][: walking[0]] = Limit.VELOCITY

    shares = limit_shares(edited(run, edit))
    assert shares["torque"][7] == shares["position"][7] == pytest.approx(25.0)
    assert not shares["velocity"].any()
    assert "held" not in shares


def test_the_lines_of_the_torque_plot_are_the_motors(run):
    figure = Figure()
    PLOTS["torque"].draw(figure, run)
    knee = next(axes for axes in figure.axes if axes.get_title().startswith("knee"))
    upper, lower = (line for line in knee.lines if line.get_linestyle() == ":")
    speed, torque = upper.get_data()
    slope = (torque[1] - torque[0]) / (speed[1] - speed[0])
    stall = torque.mean()
    assert slope < 0 < stall
    assert lower.get_ydata().mean() == pytest.approx(-stall)
    # The free speed of an XL/XH servo at about 12 V is a few rad/s: where the line meets zero.
    assert 2.0 < -stall / slope < 12.0
    measured = run.rows["frame"]["joint_torque"][:, 3]
    assert np.abs(measured).max() < 2.5 * stall


def test_water_is_drawn_around_the_robot_as_high_as_it_is():
    wet = walk(4.0, water_level=np.full(400, 0.1))
    description = load_robot("minibiped")
    heights = []
    for trace in (wet, walk(4.0)):
        axes = Figure().add_subplot()
        draw_strip(axes, trace, description)
        ends = [line.get_ydata() for line in axes.lines if len(line.get_ydata()) == 2]
        heights.append(sum(tuple(pair) == (0.1, 0.1) for pair in ends))
    assert heights == [10, 0]


def test_a_wet_run_has_a_plot_of_its_water_and_a_dry_one_none(run, tmp_path):
    def edit(rows):
        rows["reference"]["water_level"] = np.linspace(0, 0.1, len(rows))

    wet = edited(run, edit)
    assert is_wet(wet) and PLOTS["water"].applies(wet)
    assert not PLOTS["water"].applies(run)
    draw_plot("water", wet, tmp_path / "water.png", dpi=40)
    assert (tmp_path / "water.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("field", ["joint_temperature", "joint_voltage"])
def test_servos_of_which_one_kind_was_never_heard_are_drawn(run, field, tmp_path):
    def edit(rows):
        rows["frame"]["joint_temperature"] = 40.0
        rows["frame"]["joint_voltage"] = 12.0
        rows["frame"][field] = np.nan

    draw_plot("servos", edited(run, edit), tmp_path / "servos.png", dpi=40)
    assert (tmp_path / "servos.png").is_file()


def test_a_recording_from_another_computer_finds_its_robot(short_walk, tmp_path):
    recording = read_recording(short_walk)
    meta = {**recording.meta, "description": "/opt/elsewhere/hil/robots/minibiped/minibiped.yaml"}
    write_mcap(Recording(meta, recording.rows[:50], True), tmp_path / "session.mcap")
    assert plotted_run(tmp_path).description.name == recording.meta["robot"]


def test_a_run_that_never_walked_has_the_plots_that_need_no_walk(run):
    def edit(rows):
        rows["safety"]["walking"] = False

    still = edited(run, edit)
    assert [name for name, plot in PLOTS.items() if plot.applies(still)] == [
        "servos", "timing", "safety",
    ]  # fmt: skip


def test_the_command_draws_one_plot_and_says_what_there_is(short_walk, tmp_path):
    shutil.copytree(short_walk, tmp_path / "run")
    result = stride("plot", tmp_path / "run", "--figure", "gait")
    assert result.exit_code == 0
    assert (tmp_path / "run" / "gait.png").stat().st_size > 10_000
    unknown = stride("plot", tmp_path / "run", "--figure", "gate")
    assert unknown.exit_code == 2
    assert "valid: walk, speed, gait" in unknown.stderr
    dry = stride("plot", tmp_path / "run", "--figure", "water")
    assert (dry.exit_code, "water" in dry.stderr) == (2, True)
    assert stride("plot", tmp_path / "run", "--figure", "gait", "--html").exit_code == 2


def test_a_recording_of_an_older_version_is_drawn_too(short_walk, tmp_path):
    """Without fields that came later."""
    recording = read_recording(short_walk)
    rows = recording.rows
    old = [(name, rows.dtype[name]) for name in rows.dtype.names]
    status = rows.dtype["status"]
    kept = [(name, status[name]) for name in status.names if name != "wanted_speed"]
    old = [(name, np.dtype(kept)) if name == "status" else (name, kind) for name, kind in old]
    before = np.zeros(len(rows), np.dtype(old))
    for name, kind in old:
        for field in kind.names or ():
            before[name][field] = rows[name][field]
        if not kind.names:
            before[name] = rows[name]
    write_mcap(Recording(recording.meta, before, True), tmp_path / "session.mcap")
    draw_plot("speed", plotted_run(tmp_path), tmp_path / "speed.png", dpi=40)
    assert (tmp_path / "speed.png").is_file()
