"""`stride jump`: lands where it was told, on a step too; what is refused; what ends early."""

import csv
import json

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.compose import build
from hil.interface import AppliedCommand, SensorFrame
from hil.jump_report import flight_of
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.safety.assembly import make_supervisor
from hil.safety.decision import Action
from hil.safety.monitor import Situation
from hil.studies.jumps import summary, verdict
from hil.studies.walks import walk

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


@pytest.fixture(scope="module")
def forward():
    return jump((0.3, 0.0, 0.0))


def test_a_jump_lands_standing_on_its_target(forward):
    report = forward.report
    assert report["landed_standing"] and not report["fell"]
    assert report["landing_error_m"] < 0.03
    assert abs(report["apex_error_m"]) < 0.03
    assert report["takeoff_velocity_error_mps"] < 0.2
    assert report["airtime_s"] == pytest.approx(0.4, abs=0.03)


def test_both_feet_leave_the_ground_and_rise(forward):
    begin, end = flight_of(forward.trace)
    load = forward.trace.foot_force.sum(axis=(1, 2))
    assert (load[begin:end] < 10.0).all() and load[begin - 30] > 600.0
    assert forward.trace.com[begin:end, 2].max() > forward.trace.com[0, 2] + 0.03


def test_a_step_down_is_landed_on():
    down = jump((0.3, 0.0, -0.15), 0.35)
    assert down.report["landed_standing"] and down.report["landing_error_m"] < 0.03
    assert down.trace.com[-1, 2] < down.trace.com[0, 2] - 0.1


def test_a_step_that_nobody_told_of_ends_the_flight_early_and_is_landed_on():
    box = "plant.platform=[0.2, 2.0, -2.0, 2.0, 0.04]"
    jumped = jump((0.35, 0.0, 0.0), 0.4, overrides=(box,))
    begin, end = flight_of(jumped.trace)
    assert (end - begin) / 300.0 < 0.39
    assert jumped.report["landed_standing"]


def run(*arguments):
    return CliRunner().invoke(app, ["jump", *map(str, arguments)])


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--target", 0, 0, 0, "--airtime", 0.8], "the largest that fits"),
        (["--target", 0.1, 0, 0.15], "room for the feet"),
        (["--target", 0.4, 0, 0.15, "--airtime", 0.1], "--airtime"),
        (["minibiped", "--target", 0, 0, 0, "--airtime", 0.1], "largest that"),
        (["human", "--push-depth", 0], "--push-depth"),
    ],
    ids=lambda part: " ".join(map(str, part)) if isinstance(part, list) else part,
)
def test_what_cannot_be_done_is_refused_before_anything_moves(arguments, named, tmp_path):
    out = tmp_path / "out"
    result = run(*arguments, "--out", out)
    assert result.exit_code == 2 and named in result.stderr
    assert result.stderr.count("\n") == 1 and not out.exists()


def test_the_run_folder_is_that_of_a_walk(tmp_path):
    out = tmp_path / "out"
    result = run("--duration", 2.2, "--out", out, "--report", tmp_path / "copy.json", "--json")
    assert result.exit_code == 0, result.stderr
    for name in ("meta.json", "session.mcap", "report.json", "picture.png"):
        assert (out / name).is_file()
    report = json.loads((tmp_path / "copy.json").read_text())
    assert report["landing_error_m"] < 0.05 and report["peak_joint_torque_ratio"] > 0.3
    assert json.loads((out / "meta.json").read_text())["rung"] == "simulation, jump"


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


def test_a_small_study_tells_each_cell(tmp_path):
    out = tmp_path / "study"
    arguments = ["-x", 0, "-y", 0, "-z", 0, "-z", 0.15, "-t", 0.4, "--jobs", 1, "--out", out]
    result = CliRunner().invoke(app, ["study", "jumps", *map(str, arguments)])
    assert result.exit_code == 0, result.stderr
    rows = list(csv.DictReader((out / "jumps.csv").open()))
    assert [row["landed_standing"] for row in rows] == ["True", ""]
    assert "room for the feet" in rows[1]["error"] and (out / "jumps.png").is_file()
    assert "1 of 2 jumps are feasible" in result.stdout + result.stderr
