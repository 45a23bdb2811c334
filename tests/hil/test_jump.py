"""`stride jump`: lands where it was told, on a step too; what is refused; what ends early."""

import csv
import json
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from controller.jumping.path import JumpTarget, estimate_path
from hil.cli.main import app
from hil.compose import build
from hil.figures_jump_run import draw_jump_run, ground_force, key_moments
from hil.interface import AppliedCommand, SensorFrame
from hil.jump_report import JumpReview, flight_of
from hil.recording import read_recording
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.safety.assembly import make_supervisor
from hil.safety.decision import Action
from hil.safety.monitor import Situation
from hil.studies.jumps import JumpStudy, summary, verdict
from hil.studies.walks import Walk, walk

STANDING = {"speed": ((0.0, 0.0),)}


def jump(target, airtime=0.4, duration_s=2.8, **more):
    order = {"target": target, "airtime": airtime, "push_depth": 0.298}
    return walk(
        RunRequest.checked(
            robot="human",
            activity="jump",
            jump=order,
            duration_s=duration_s,
            schedules=STANDING,
            **more,
        )
    )


def run(*arguments):
    return CliRunner().invoke(app, ["jump", *map(str, arguments)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of one jump, 0.3 m forward, as the command leaves it."""
    out = tmp_path_factory.mktemp("jump") / "out"
    result = run("--duration", 2.6, "--out", out)
    assert result.exit_code == 0, result.output
    return out


@pytest.fixture(scope="module")
def report(folder):
    return json.loads((folder / "report.json").read_text())


@pytest.fixture(scope="module")
def trace(folder):
    return read_recording(folder).trace()


def test_a_jump_lands_standing_on_its_target(report):
    assert report["landed_standing"] and not report["fell"]
    assert report["landing_error_m"] < 0.03
    assert abs(report["apex_error_m"]) < 0.03
    assert report["takeoff_velocity_error_mps"] < 0.2
    assert report["airtime_s"] == pytest.approx(0.4, abs=0.03)


def test_both_feet_leave_the_ground_and_rise(trace):
    begin, end = flight_of(trace)
    load = trace.foot_force.sum(axis=(1, 2))
    assert (load[begin:end] < 10.0).all() and load[begin - 30] > 600.0
    assert trace.com[begin:end, 2].max() > trace.com[0, 2] + 0.03


def test_a_step_down_is_landed_on_though_the_heels_brush_its_edge():
    """Both at once: the landing begins in the air, on legs that must not fold before the floor."""
    down = jump((0.3, 0.0, -0.15), 0.35, duration_s=3.2)
    assert down.report["landed_standing"] and down.report["landing_error_m"] < 0.03
    assert down.trace.com[-1, 2] < down.trace.com[0, 2] - 0.1
    begin, end = flight_of(down.trace)
    assert 0.0 < (end - begin) / 300.0 < 0.3  # until the brush


def test_a_step_that_nobody_told_of_ends_the_flight_early_and_is_landed_on():
    box = "plant.platform=[0.2, 2.0, -2.0, 2.0, 0.04]"
    jumped = jump((0.35, 0.0, 0.0), 0.4, overrides=(box,))
    begin, end = flight_of(jumped.trace)
    assert (end - begin) / 300.0 < 0.39
    assert jumped.report["landed_standing"]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--target", 0, 0, 0, "--airtime", 0.8], "the largest that fits"),
        (["--target", 0.1, 0, 0.15], "room for the feet"),
        (["--target", 0.4, 0, 0.15, "--airtime", 0.1], "--airtime"),
        (["human", "--push-depth", 0], "--push-depth"),
    ],
    ids=lambda part: " ".join(map(str, part)) if isinstance(part, list) else part,
)
def test_what_cannot_be_done_is_refused_before_anything_moves(
    arguments, named, tmp_path, monkeypatch
):
    monkeypatch.setattr("controller.jumping.feasibility.HALVINGS", 1)  # a coarse search is fast
    out = tmp_path / "out"
    result = run(*arguments, "--out", out)
    assert result.exit_code == 2 and named in result.stderr
    assert result.stderr.count("\n") == 1 and not out.exists()


def test_the_run_folder_is_that_of_a_walk(folder, report):
    for name in ("meta.json", "session.mcap", "report.json", "picture.png"):
        assert (folder / name).is_file()
    assert report["peak_joint_torque_ratio"] > 0.3
    assert json.loads((folder / "meta.json").read_text())["rung"] == "simulation, jump"


def test_a_jump_that_does_not_end_standing_is_no_success(tmp_path):
    out, copy = tmp_path / "out", tmp_path / "copy.json"
    result = run("--duration", 0.3, "--out", out, "--report", copy, "--json")
    assert result.exit_code == 1, result.output
    report = json.loads(copy.read_text())
    assert report["landed_standing"] is False and report["faults"] == []
    assert (out / "picture.png").is_file()


def test_plotting_a_jump_leaves_its_picture_alone(folder):
    before = (folder / "picture.png").read_bytes()
    result = CliRunner().invoke(app, ["plot", str(folder)])
    assert result.exit_code == 0, result.output
    assert (folder / "walk.png").is_file() and (folder / "picture.png").read_bytes() == before


def test_the_picture_has_the_moments_of_a_jump_in_order(trace):
    moments = key_moments(trace, flight_of(trace))
    names = ["start", "crouch", "take-off", "apex", "touch-down", "lowest", "end"]
    assert list(moments.values()) == names
    at = {name: tick for tick, name in moments.items()}
    height = trace.com[:, 2]
    assert height[at["crouch"]] < height[at["take-off"]] < height[at["apex"]]
    assert height[at["lowest"]] < height[at["touch-down"]] < height[at["apex"]]


def test_the_ground_pushes_with_the_weight_at_rest_and_not_at_all_in_the_air(trace):
    force, (begin, end) = ground_force(trace, 70.4, 9.81), flight_of(trace)
    assert (force[begin:end] == 0.0).all() and force[begin - 30, 2] > 690.0
    assert force[-1, 2] == pytest.approx(690.0, rel=0.05)
    on_the_moon = ground_force(trace, 70.4, 1.62)
    assert on_the_moon[-1, 2] == pytest.approx(70.4 * 1.62, abs=0.05 * 690.0)
    assert (force - on_the_moon)[-1, 2] == pytest.approx(70.4 * 8.19)


def test_the_picture_shows_path_support_and_load(trace, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    path = estimate_path(JumpTarget((0.3, 0.0, 0.0), 0.4, 0.298), 70.4, start=(0.08, 0.0, 0.63))
    plan = SimpleNamespace(path=path, feet=np.zeros(3), landing_feet=np.array((0.3, 0.0, 0.0)))
    soles = np.array([[(x, y, 0.0) for x in (0.0, 0.14)] * 2 for y in (-0.1, 0.1)])
    soles[:, 2:, 1] *= 1.3
    review = JumpReview(lambda: plan, lambda *_: soles, lambda: 1.0)
    meta = {"robot": "human", "rung": "jump", "rate_hz": 300, "seed": 0, "weight_n": 690.0}
    draw_jump_run(trace, load_robot("human"), meta, review, tmp_path / "picture.png")
    strip, side, before, after, load = drawn[0].axes
    assert len(strip.texts) == 7
    planned, measured = side.lines
    assert planned.get_ydata().max() == pytest.approx(path.apex[2], abs=1e-3)
    assert measured.get_ydata().max() == pytest.approx(trace.com[:, 2].max())
    assert len(side.texts) == 14  # arrows
    for axes in (before, after):
        assert np.ptp(axes.patches[0].get_xy()[:, 0]) == pytest.approx(0.26)
    assert load.get_xlim()[1] == pytest.approx(trace.time_s[-1])
    assert load.lines[-1].get_ydata()[0] == pytest.approx(690.0)
    moon = load_robot("human", ("plant.gravity=1.62",))
    draw_jump_run(trace, moon, meta, review, tmp_path / "picture.png")
    *_, load = drawn[1].axes
    assert load.lines[-1].get_ydata()[0] == pytest.approx(690.0 * 1.62 / 9.81)  # its weight there


@pytest.mark.parametrize(("feet", "action"), [("leap", Action.RUN), ("carry", Action.SIT)])
def test_only_a_jump_may_leave_the_ground(feet, action):
    """Two seconds without any load: a walk is stopped for it, a jump is not."""
    description = load_robot("minibiped")
    session = build(RunRequest(robot="minibiped", backend="mujoco"))
    frame = SensorFrame.empty(12)
    frame.joint_position[:] = description.start_position
    frame.foot_valid[:] = frame.joint_valid[:] = frame.imu_valid = True
    frame.joint_age_ns[:] = frame.foot_age_ns[:] = frame.imu_age_ns = 0
    supervisor = make_supervisor(description, 300, 25.7, paced=False, feet=feet)
    motion = session.world.truth()
    supervisor.begin_walking(float(motion.base_position[2]))
    situation = Situation(0, frame, motion, AppliedCommand.zeros(12), walking=True)
    seen = Action.RUN
    for tick in range(600):
        situation.now_ns = frame.time_ns = tick * 3_333_333
        seen = supervisor.judge(situation, tick / 300.0)
        if seen is not Action.RUN:
            break
    session.close()
    assert seen is action


def test_the_study_counts_what_was_feasible():
    rows = [
        {"feasible": True, "landed_standing": True, "on_target": True},
        {"feasible": True, "landed_standing": True, "on_target": False},
        {"feasible": True, "landed_standing": False, "on_target": False},
        {"feasible": False, "landed_standing": None, "on_target": False},
    ]
    assert [verdict(row) for row in rows] == ["stands", "stands, off target", "fell", "refused"]
    assert summary(rows).startswith("3 of 4 jumps are feasible (1 refused); of these 2 land")


def test_a_study_without_a_feasible_cell_says_why(tmp_path):
    out = tmp_path / "study"
    arguments = ["-x", 0, "-y", 0, "-z", 0.15, "-t", 0.4, "--jobs", 1, "--out", out]
    result = CliRunner().invoke(app, ["study", "jumps", *map(str, arguments)])
    assert result.exit_code == 0, result.stderr
    [row] = csv.DictReader((out / "jumps.csv").open())
    assert "room for the feet" in row["error"] and (out / "jumps.png").is_file()
    assert "0 of 1 jumps are feasible" in result.stdout + result.stderr


def test_a_study_asks_for_its_grid_and_keeps_what_the_report_says(report, trace, monkeypatch):
    asked = []

    def done(request):
        asked.append((request.activity, request.jump.target, request.jump.airtime))
        return Walk(report, trace)

    monkeypatch.setattr("hil.studies.jumps.walk", done)
    study = JumpStudy(
        request=RunRequest(robot="human"),
        forward=(0.0, 0.3),
        lateral=(0.0,),
        heights=(0.0,),
        airtimes=(0.4,),
        push_depth=0.298,
    )
    rows = study.conduct(lambda work, cases: [work(case) | {"error": None} for case in cases]).rows
    assert asked == [("jump", (0.0, 0.0, 0.0), 0.4), ("jump", (0.3, 0.0, 0.0), 0.4)]
    assert [row["landing_error_m"] for row in rows] == [report["landing_error_m"]] * 2
    assert all(row["on_target"] for row in rows)
