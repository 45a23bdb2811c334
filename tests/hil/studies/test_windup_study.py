"""`stride study windup` as a user starts it, and what its tables must show."""

import csv

import numpy as np
import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.compose.windups import Jump, Spring, wound_up
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.studies.windup_case import WindupCase, narrowed, windup_of
from hil.studies.windup_rows import character_cases, gain_cases, limit_cases, muscle_cases
from hil.studies.windup_tables import settling


def study(*arguments):
    return CliRunner().invoke(app, ["study", "windup", *map(str, arguments)])


def base(robot="human", **changes):
    """A jump of a third of the leg, everything in the robot's own measure."""
    leg = {"human": 0.93, "minibiped": 0.22}[robot]
    request = RunRequest(robot=robot).resolved(load_robot(robot))
    values = {
        "displacement": (0.3 * leg, 0.0, 0.0), "airtime": 0.31 * leg**0.5,
        "push_depth": 0.35 * leg, "gravity": 9.81, "law": "chord",
    }  # fmt: skip
    return WindupCase(request=request, **(values | changes))


def test_a_quick_study_leaves_tables_pictures_and_the_animators_files(tmp_path):
    out = tmp_path / "out"
    result = study("minibiped", "--quick", "--jobs", 1, "--out", out)
    assert result.exit_code == 0, result.stderr
    for title in ("Table 3.1", "Table 3.2", "Table 3.3", "goes down"):
        assert title in result.stdout
    with (out / "windup.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["table"] for row in rows} == {"plain", "3.1", "3.2", "3.3", "characters"}
    assert rows[0]["converged"] == "True"
    assert (out / "windup.png").read_bytes().startswith(b"\x89PNG")
    frames = (out / "windup_key_frames.csv").read_text().splitlines()
    assert len(frames) == int(rows[0]["iterations"]) + 2
    bvh = (out / "windup.bvh").read_text()
    assert bvh.startswith("HIERARCHY") and f"Frames: {len(frames) - 1}" in bvh


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["human", "--law", "rubber"], "law"),
        (["human", "--target", 0, 0, 1.0], "--airtime"),
        (["human", "--gravity", -1], "gravity"),
        (["human", "--push-depth", 3.0], "knee"),
    ],
)
def test_what_cannot_be_jumped_is_told_in_a_line(arguments, named, tmp_path):
    result = study(*arguments, "--quick", "--jobs", 1, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and named in result.stderr
    assert not (tmp_path / "out").exists()


def test_constants_that_settle_and_those_that_do_not_are_told_apart_in_advance():
    """The closed form of the table's |z| agrees with windups on both sides of 1."""
    assert settling(1.0, 0.0) == 0.0
    assert settling(0.3, 0.0) == pytest.approx(0.7)
    assert settling(2.0, 0.0) == pytest.approx(1.0)
    told = [("0.5", 0.3), ("1.6", 0.0), ("1.6", 0.3), ("2.2", 0.0)]
    cases = {(f"{each['kp']}", each["kd"]): case for each, case in gain_cases(base(), few=False)}
    for kp, kd in told:
        assert windup_of(cases[kp, kd])["converged"] == (settling(float(kp), kd) < 1.0), (kp, kd)


def test_only_the_product_of_stiffness_and_width_bends_the_knee():
    found = {}
    for labels, case in muscle_cases(base(), few=False):
        if labels["law"] == "chord" and labels["scale"] in (0.7, 1.0, 1.6):
            found[labels["varied"], labels["scale"]] = windup_of(case)
    depths = [found["k", scale]["depth_m"] for scale in (0.7, 1.0, 1.6)]
    assert depths[0] > depths[1] > depths[2]
    for scale in (0.7, 1.6):
        stiff, wide = found["k", scale], found["r", scale]
        assert wide["knee_deg"] == pytest.approx(stiff["knee_deg"], abs=0.5)
        assert wide["knee_torque_nm"] == pytest.approx(scale * stiff["knee_torque_nm"], rel=0.02)


def test_narrower_knees_end_the_windup_earlier_and_are_named():
    description = load_robot("minibiped")
    cases = limit_cases(base("minibiped"), description, few=False)
    knees = [windup_of(case) for labels, case in cases if labels["joint"] == "knee"][::3]
    depths = [row["depth_m"] for row in knees]
    assert depths == sorted(depths, reverse=True)
    for row in knees:
        assert not row["converged"] and "left_knee" in row["blocked_by"]
        assert row["least_margin_m"] > 0.0


def test_narrower_hips_end_a_windup_that_begins_with_nearly_straight_legs():
    [case] = [
        case
        for labels, case in limit_cases(base(), load_robot("human"), few=False)
        if (labels["joint"], labels["share"]) == ("hip_pitch", 0.6)
    ]
    row = windup_of(case)
    assert row["blocked_by"] == "left_hip_pitch right_hip_pitch"
    assert row["depth_m"] > 0.35


def test_ranges_narrow_about_the_start_posture():
    description = narrowed(load_robot("minibiped"), ("knee", 0.5))
    knee = next(joint for joint in description.joints if joint.name == "right_knee")
    assert knee.range == pytest.approx((0.8595 - 0.5 * 0.8395, 0.8595 + 0.5 * 1.4405))
    hip = next(joint for joint in description.joints if joint.name == "right_hip_pitch")
    assert hip.range == (-1.8, 0.9)


def test_characters_are_the_same_jump_with_other_gravity_or_mass():
    forces = {
        labels["character"]: windup_of(case)["wanted_force_n"]
        for labels, case in character_cases(base(), few=False)
        if labels["law"] == "chord"
    }
    assert forces["double mass"] == pytest.approx(2.0 * forces["Earth"])
    assert forces["half mass"] == pytest.approx(0.5 * forces["Earth"])
    assert forces["Moon"] < forces["Mars"] < forces["Earth"]


def test_a_matched_stiffness_makes_the_windup_as_deep_as_the_push():
    description = load_robot("human")
    jump = Jump((0.28, 0.0, 0.0), 0.3, 0.33, 9.81)
    plain = wound_up(description, jump, Spring("chord"), 0.033, {})
    scale = plain.push_stiffness / plain.stiffness
    deep = wound_up(description, jump, Spring("chord", stiffness_scale=scale), 0.033, {})
    drop = deep.base_positions[0, 2] - deep.base_positions[-1, 2]
    assert drop == pytest.approx(0.33, abs=0.012)
    planned = deep.planned
    assert planned[0] == pytest.approx(deep.coms[-1])
    assert planned[-1, 0] - planned[0, 0] > 0.28
    assert np.all(np.diff(deep.errors) < 0.0)
