"""A robot folder from somebody's model: the same robot, and one that walks."""

import itertools
import json
import re

import mujoco
import numpy as np
import pytest
import yaml
from foreign_bipeds import Foreign
from typer.testing import CliRunner

from hil.cli.main import app
from hil.robot_files import load_robot

ROLES = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
COMMENT = re.compile(r"name: (\w+),.*?# (\S+) ([+-]1)(?: ([+-][\d.]+))?", re.S)
VARIANTS = {
    "plain": Foreign(),
    "pitch first": Foreign(hip_order=("pitch", "roll", "yaw")),
    "roll first, bent knees": Foreign(hip_order=("roll", "yaw", "pitch"), knee_bend=0.3),
    "offset hips": Foreign(hip_gap=-0.012),
    "looks back": Foreign(facing='euler="0 0 3.14159265"'),
    "looks left, no waist": Foreign(facing='euler="0 0 1.57079633"', waist=False),
    "CamelCase": Foreign(names="{side}{joint}", sides=("L", "R"), sign=1),
}


def stride(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def made(tmp_path, foreign, *options):
    """The source model and the files that new-robot makes of it."""
    source = tmp_path / "theirs.xml"
    text = foreign.text()
    if foreign.names == "{side}{joint}":
        text = re.sub(r'name="([LR])(\w)', lambda m: f'name="{m[1]}{m[2].upper()}', text)
        text = re.sub(r'joint="([LR])(\w)', lambda m: f'joint="{m[1]}{m[2].upper()}', text)
    source.write_text(text)
    result = stride("new-robot", source, "--name", "mine", "--out", tmp_path / "mine", *options)
    assert result.exit_code == 0, result.output
    return mujoco.MjModel.from_xml_path(str(source)), tmp_path / "mine" / "mine.yaml"


def mapping(file):
    """Per joint of ours: joint of theirs, sign, offset, as the comments of the file say."""
    return {
        ours: (theirs, int(sign), float(offset or 0.0))
        for ours, theirs, sign, offset in COMMENT.findall(file.read_text())
    }


def placed(model, angles):
    """Kinematics of a model with joints at angles, by name."""
    data = mujoco.MjData(model)
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_forward(model, data)
    return data


@pytest.mark.parametrize("foreign", VARIANTS.values(), ids=VARIANTS.keys())
def test_the_written_model_moves_and_weighs_as_theirs(tmp_path, foreign):
    theirs, file = made(tmp_path, foreign)
    ours = mujoco.MjModel.from_xml_path(str(file.with_suffix(".xml")))
    joints = mapping(file)
    assert sorted(joints) == sorted(
        f"{s}_{r}" for s, r in itertools.product(("left", "right"), ROLES)
    )
    rng = np.random.default_rng(3)
    for _ in range(5):
        angles = {name: rng.uniform(-0.4, 0.4) for name in joints}
        mine = placed(ours, angles)
        other = placed(
            theirs, {name: s * (angles[ours_] + o) for ours_, (name, s, o) in joints.items()}
        )

        # One rotation and shift about z between the two worlds: distances and masses agree.
        def spread(model, data, names):
            points = [data.xanchor[model.joint(name).id] for name in names]
            return np.array([np.linalg.norm(a - b) for a, b in itertools.combinations(points, 2)])

        knees = ["left_knee", "right_knee"]
        np.testing.assert_allclose(
            spread(ours, mine, knees),
            spread(theirs, other, [joints[k][0] for k in knees]),
            atol=1e-5,
        )
        np.testing.assert_allclose(
            mine.subtree_com[1][2] - mine.xanchor[ours.joint("left_knee").id][2],
            other.subtree_com[1][2] - other.xanchor[theirs.joint(joints["left_knee"][0]).id][2],
            atol=1e-5,
        )
        full = [np.zeros((m.nv, m.nv)) for m in (ours, theirs)]
        for matrix, model, data in zip(full, (ours, theirs), (mine, other), strict=True):
            mujoco.mj_fullM(model, data, matrix)
        rows = [ours.joint(name).dofadr[0] for name in joints]
        rows_theirs = [theirs.joint(name).dofadr[0] for name, _, _ in joints.values()]
        signs = np.array([s for _, s, _ in joints.values()])
        expected = full[1][np.ix_(rows_theirs, rows_theirs)] * np.outer(signs, signs)
        np.testing.assert_allclose(full[0][np.ix_(rows, rows)], expected, atol=2e-6)
    assert ours.body_subtreemass[1] == pytest.approx(theirs.body_subtreemass[1])


def test_the_zero_pose_is_upright_level_and_ahead(tmp_path):
    _, file = made(tmp_path, VARIANTS["looks back"])
    model = mujoco.MjModel.from_xml_path(str(file.with_suffix(".xml")))
    data = placed(model, {})
    points = {n: data.xanchor[model.joint(n).id] for n in mapping(file)}
    for side, y in (("left", 0.04), ("right", -0.04)):
        hip, knee, ankle = (points[f"{side}_{r}"] for r in ("hip_pitch", "knee", "ankle_roll"))
        np.testing.assert_allclose([hip[0] - knee[0], knee[0] - ankle[0]], 0.0, atol=1e-6)
        np.testing.assert_allclose(
            [hip[1], hip[2] - knee[2], knee[2] - ankle[2]], [y, 0.12, 0.11], atol=1e-6
        )
    sole = model.geom("left_sole").id
    np.testing.assert_allclose(
        data.geom_xpos[sole][:2] - points["left_ankle_roll"][:2], [0.012, 0.0], atol=1e-6
    )
    np.testing.assert_allclose(model.geom_size[sole][:2], [0.06, 0.035], atol=1e-6)


def test_limits_are_the_models_where_it_has_them_and_scaled_where_not(tmp_path):
    _, file = made(tmp_path, Foreign(knee_bend=0.3))
    joints = {joint.name: joint for joint in load_robot(str(file)).joints}
    assert joints["left_knee"].torque_limit == pytest.approx(6.0)
    assert joints["left_knee"].range == pytest.approx((-2.3, 2.9), abs=1e-3)
    minibiped = {joint.name: joint for joint in load_robot("minibiped").joints}
    mass, leg = 2.82 / 2.62, 0.23 / 0.22
    expected = minibiped["left_hip_roll"].torque_limit * mass * leg
    assert joints["left_hip_roll"].torque_limit == pytest.approx(expected, rel=0.02)
    text = file.read_text()
    assert "# l_knee +1 -0.3000; (assumed): velocity_limit" in text


def test_similar_gives_every_joint_a_scaled_servo(tmp_path):
    _, file = made(tmp_path, Foreign(), "--similar")
    limits = {joint.torque_limit for joint in load_robot(str(file)).joints}
    assert len(limits) == 1 and limits.pop() < 6.0


def test_it_walks_in_mujoco_with_no_servo_filled_in(tmp_path):
    """Its hip axes come in another order and pass each other: the closed form alone falls."""
    foreign = Foreign(hip_order=("pitch", "roll", "yaw"), hip_gap=-0.012)
    _, file = made(tmp_path, foreign, "--similar")
    run = tmp_path / "run"
    result = stride("walk", file, "--duration", "4", "--out", run, "--json")
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert not report["fell"] and report["steps"] >= 8
    assert report["mean_speed_mps"] == pytest.approx(report["target_speed_mps"], abs=0.05)


def test_a_servo_model_leads_straight_to_the_dry_run(tmp_path):
    _, file = made(tmp_path, Foreign(), "--servo", "XM430-W350")
    result = stride("walk", file, "--duration", "2", "--out", tmp_path / "run", "--json")
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert report["bus"] == "virtual" and not report["fell"] and report["bus_timeouts"] == 0


def test_no_bus_opens_before_servos_are_filled_in(tmp_path):
    _, file = made(tmp_path, Foreign())
    for command in (
        ("walk", file, "--backend", "bus"),
        ("emulate", file),
        ("stand", file, "--live"),
    ):
        result = stride(*command)
        assert result.exit_code == 2 and result.stderr.count("\n") == 1, result.output
        assert "servo" in result.stderr


def test_findings_name_what_is_assumed_held_and_to_be_looked_at(tmp_path):
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign(hip_gap=-0.012, limits="").text())
    result = stride("new-robot", source, "--json", "--out", tmp_path / "out")
    findings = json.loads(result.stdout)["findings"]
    said = {(row["kind"], row["what"]): row["says"] for row in findings}
    assert "waist" in said["left out", "other joints"]
    assert "12 of 12" in said["assumed", "range"]
    assert "mm" in said["look at", "leg axes"]
    assert "2.82 kg" in said["found", "mass, leg"]
    assert ("to fill in", "servos") in said


def test_a_foot_without_shape_gets_a_sole_and_says_so(tmp_path):
    foot = '<inertial pos="0 0 -.02" mass=".1" diaginertia="1e-4 1e-4 1e-4"/>'
    source = tmp_path / "theirs.xml"
    source.write_text(Foreign(foot=foot).text())
    result = stride("new-robot", source, "--json", "--out", tmp_path / "out")
    kinds = {row["what"]: row["kind"] for row in json.loads(result.stdout)["findings"]}
    assert kinds["soles"] == "assumed"


def test_yaml_has_the_keys_of_the_pattern(tmp_path):
    _, file = made(tmp_path, Foreign())
    ours, like = yaml.safe_load(file.read_text()), load_robot("minibiped")
    assert ours["walking"].keys() == like.walking.keys()
    assert ours["noise"].keys() == like.noise.model_dump().keys()
