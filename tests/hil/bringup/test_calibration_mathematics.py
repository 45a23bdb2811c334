"""The mathematics of calibration: mountings from tilts, scales from weights, who disagrees."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.bringup.cell_fit import fit_scales
from hil.bringup.imu_mounting import MountingError, mounting_from_tilts
from hil.bringup.lean_verdict import LeanEvidence, judge
from hil.bringup.motion_words import motion_words
from hil.bringup.sole_level import SoleLevel, lean_of
from hil.robot_files import load_robot

angle = st.floats(-np.pi, np.pi)


def rotation(roll, pitch, yaw):
    """Rz·Ry·Rx, written out independently of the code under test."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    return np.array([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])  # fmt: skip


def matrix(q):
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def forces(to_base, *leans):
    """What an accelerometer with this mounting says on a torso with these rolls and pitches."""
    up = np.array([0.0, 0.0, 9.81])
    return [to_base.T @ rotation(roll, pitch, 0.0).T @ up for roll, pitch in leans]


LEVEL, FORWARD, LEFT = (0.0, 0.0), (0.0, 0.4), (-0.4, 0.0)


@given(roll=angle, pitch=st.floats(-1.4, 1.4), yaw=angle)
@settings(max_examples=100, deadline=None)
def test_any_mounting_is_found_again(roll, pitch, yaw):
    true = rotation(roll, pitch, yaw)
    found = mounting_from_tilts(*forces(true, LEVEL, FORWARD, LEFT), square=False)
    assert matrix(found.quaternion) == pytest.approx(true, abs=1e-6)


def test_a_hand_that_tilts_a_little_askew_does_not_turn_a_square_board():
    true = rotation(0.02, -0.03, np.pi / 2)
    seen = forces(true, LEVEL, (0.03, 0.4), (-0.4, 0.02))
    measured = mounting_from_tilts(*seen, square=False)
    assert np.abs(matrix(measured.quaternion) - true).max() > 0.02
    square = mounting_from_tilts(*seen, square=True)
    assert np.abs(matrix(square.quaternion) - true).max() < 0.005


@pytest.mark.parametrize(
    ("leans", "says"),
    [
        ((LEVEL, (0.0, -0.4), LEFT), "contradict each other"),
        ((LEVEL, FORWARD, (0.4, 0.0)), "contradict each other"),
        ((LEVEL, (0.0, 0.1), LEFT), "tilted forward by 6°: too little"),
        ((LEVEL, FORWARD, (-1.4, 0.0)), "tilted left by 80°: too much"),
        ((LEVEL, FORWARD, (-0.3, 0.3)), "apart and not 90°"),
    ],
)
def test_tilts_that_no_mounting_explains_are_refused(leans, says):
    with pytest.raises(MountingError, match=says):
        mounting_from_tilts(*forces(np.eye(3), *leans), square=True)


@given(
    scale=st.lists(st.floats(2e-4, 2e-3), min_size=4, max_size=4),
    signs=st.lists(st.sampled_from([-1.0, 1.0]), min_size=4, max_size=4),
    astray=st.floats(0.0, 0.25),
)
@settings(max_examples=100, deadline=None)
def test_scales_are_found_wherever_on_the_sole_the_weights_stood(scale, signs, astray):
    """A weight beside its corner loads the others too; only the sum is its weight."""
    scale = np.array(scale) * signs
    shares = np.vstack([(1 - astray) * np.eye(4) + astray / 4, np.full(4, 0.25)])
    weights = np.array([9.81, 9.81, 4.905, 9.81, 19.62])
    counts = shares * weights[:, None] / scale
    found = fit_scales(counts, weights)
    assert found.scale == pytest.approx(scale, rel=1e-6)
    assert found.residual < 1e-6


def test_a_weight_that_is_not_what_was_said_is_left_over():
    counts = np.vstack([np.eye(4), np.full(4, 0.25)]) * 1e4
    weights = np.array([9.81, 9.81, 9.81, 9.81, 7.0])
    assert fit_scales(counts, weights).residual > 0.5


def test_placements_that_repeat_each_other_are_refused():
    with pytest.raises(ValueError, match="same places"):
        fit_scales(np.full((5, 4), 100.0), np.full(5, 9.81))
    with pytest.raises(ValueError, match="never answered"):
        fit_scales(np.array([[1.0, 1.0, 1.0, 0.0]] * 5), np.full(5, 9.81))


def test_soles_that_stand_flat_tell_the_lean_of_the_torso():
    """With flat soles a leg's rolls and pitches add up to minus the torso's."""
    soles = SoleLevel(load_robot("minibiped"))
    up = soles.up({"left_hip_roll": 0.04, "left_ankle_roll": 0.06, "right_hip_pitch": -0.5,
                   "right_knee": 0.6, "right_ankle_pitch": -0.3})  # fmt: skip
    assert lean_of(up["left"]) == pytest.approx([-0.10, 0.0], abs=1e-6)
    assert lean_of(up["right"]) == pytest.approx([0.0, 0.2], abs=1e-6)


LEFTWARD, RIGHTWARD, AHEAD = np.radians([[-8.0, 0.5], [8.0, 0.5], [0.5, 8.0]])


@pytest.mark.parametrize(
    ("evidence", "who"),
    [
        (LeanEvidence("left", LEFTWARD, {"left": LEFTWARD}, 0.3), []),
        (LeanEvidence("right", RIGHTWARD, {"right": RIGHTWARD}, -0.3), []),
        (LeanEvidence("forward", AHEAD, {"left": AHEAD, "right": AHEAD}, 0.3), []),
        (LeanEvidence("left", RIGHTWARD, {"left": LEFTWARD}, 0.3), ["imu"]),
        (LeanEvidence("left", LEFTWARD, {"left": RIGHTWARD}, 0.3), ["left leg"]),
        (LeanEvidence("left", LEFTWARD, {"left": LEFTWARD}, -0.3), ["cells"]),
        (LeanEvidence("left", LEFTWARD, {"left": 0 * LEFTWARD}, 0.3), ["left leg"]),
        (LeanEvidence("forward", AHEAD, {"left": AHEAD, "right": -AHEAD}, 0.3), ["right leg"]),
        (LeanEvidence("left", RIGHTWARD, {"left": RIGHTWARD}, -0.3), ["lean"]),
        (LeanEvidence("left", 0 * LEFTWARD, {}, 0.0), ["lean"]),
        (LeanEvidence("left", LEFTWARD, {}, None), []),
    ],
)
def test_who_disagrees_is_named(evidence, who):
    assert [culprit.who for culprit in judge(evidence)] == who


def test_positive_senses_are_told_as_one_sees_them():
    """REP 103: x forward, y left, z up; a positive knee bends, its foot goes back."""
    words = motion_words(load_robot("minibiped"))
    assert words["left_knee"] == "the left foot moves backward"
    assert words["right_hip_roll"] == "the right foot moves to the left"
    assert words["left_hip_yaw"] == "the toes of the left foot move to the left"
    assert words["right_ankle_pitch"] == "the toes of the right foot move down"
    assert words["left_ankle_roll"] == "the left rim of the left sole moves up"
