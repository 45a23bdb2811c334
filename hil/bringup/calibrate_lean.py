"""Leaning left, right and forward by hand: IMU, joints and cells must tell of the same lean."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.bringup.calibrating import Calibrating
from hil.bringup.deed import Deed
from hil.bringup.lean_verdict import LEANS, LOADED, Culprit, LeanEvidence, judge
from hil.bringup.moment import Moment
from hil.bringup.sole_level import SoleLevel, lean_of
from hil.errors import InputError
from hil.interface import Floats
from hil.robot_facts import body_weight

ASKED_RAD = np.radians(9.0)
WEIGHT_TOLERANCE = 0.4
"""Of the weight: hands help to hold the robot (assumed)."""
_TILTS = {"left": (-ASKED_RAD, 0.0), "right": (ASKED_RAD, 0.0), "forward": (0.0, ASKED_RAD)}
_TOLD = {
    "left": "to its left, so that its left foot carries more",
    "right": "to its right, so that its right foot carries more",
    "forward": "forward, so that its toes carry more",
}


@dataclass(frozen=True, slots=True)
class _State:
    """What the calibrated robot said in one moment."""

    angles: dict[str, float]
    imu: Floats
    """Roll and pitch [rad]."""
    force: Floats
    """[N], shape (2, 4)."""


def calibrate_lean(work: Calibrating) -> dict[str, LeanEvidence]:
    """Ask for three leans and judge; what was seen is returned, by lean.

    The file is told which values agreed. Raises RefusedError that names who does not.
    """
    calibration = work.file.calibration
    calibration.require_whole(work.description, str(work.file.path))
    soles = SoleLevel(work.description)
    seen = {}
    stand = dict.fromkeys(work.description.joint_names, 0.0) | work.description.start.joints
    upright: tuple[Deed, ...] = (
        Deed(lifted=True, tilt=(0.0, 0.0), joints=stand), Deed(lifted=False), Deed(released=True),
    )  # fmt: skip
    for lean in LEANS:
        work.wait("Stand the robot upright on both feet, soles flat, legs bent, and hold it so "
                  "that its feet carry it", *upright)  # fmt: skip
        before = _state(work, work.still())
        work.wait(
            f"Lean it {_TOLD[lean]}, soles flat, and hold it",
            Deed(free=_limp(work, lean), tilt=_TILTS[lean]),
        )
        after = _state(work, work.still())
        seen[lean] = _evidence(soles, lean, before, after)
        if lean == LEANS[0]:
            _weigh(work, before)
            work.settle()
        for culprit in judge(seen[lean]):
            where, advice = _explain(soles, culprit, lean, before, after)
            work.inspection.expect(False, where, f"leaning {lean}: {culprit.what}", advice)
        upright = (Deed(tilt=(0.0, 0.0)), Deed(joints=stand))
    work.settle()
    work.file.keep("lean", "leant left, right and forward", None, {},
                   {"agreed": calibration.identity()})  # fmt: skip
    return seen


def _weigh(work: Calibrating, upright: _State) -> None:
    """Cells with a wrong zero or scale, or those of the other foot, do not know the weight."""
    own, found = body_weight(work.description), float(upright.force.sum())
    work.inspection.expect(
        not upright.force.any() or abs(found - own) <= WEIGHT_TOLERANCE * own, "cells",
        f"weigh the robot as {found:.1f} N, its mass says {own:.1f} N",
        "feet exchanged, or a hand carries it; else stride calibrate feet",
    )  # fmt: skip


def _limp(work: Calibrating, lean: str) -> tuple[str, ...]:
    """Joints that a virtual hand lets go of, so that the torso leans and the soles stay flat."""
    name = "hip_pitch" if lean == "forward" else "roll"
    return tuple(joint for joint in work.description.joint_names if joint.endswith(name))


def _state(work: Calibrating, moment: Moment) -> _State:
    calibration = work.file.calibration
    if moment.imu is None:
        raise InputError("imu: its board sends nothing valid: stride check")
    up = np.zeros(3)
    mujoco.mju_rotVecQuat(up, moment.imu.force, np.array(calibration.imu.mounting))
    force = np.zeros((2, 4))
    for index, side in enumerate(work.description.feet):
        if side in calibration.feet and side in moment.feet:
            foot = calibration.feet[side]
            force[index] = (moment.feet[side].mean - np.array(foot.zero)) * np.array(foot.scale)
    offsets = calibration.joint_offsets
    angles = {joint: raw - offsets.get(joint, 0.0) for joint, raw in moment.angles.items()}
    return _State(angles, lean_of(up), force)


def _evidence(soles: SoleLevel, lean: str, before: _State, after: _State) -> LeanEvidence:
    total = float(after.force.sum())
    loaded = after.force.sum(axis=1) > LOADED * total
    legs = _legs(soles, before.angles, after.angles)
    joints = {side: legs[side] for side, carries in zip(legs, loaded, strict=True) if carries}
    return LeanEvidence(lean, after.imu - before.imu, joints, _share_risen(lean, before, after))


def _legs(soles: SoleLevel, before: dict[str, float], after: dict[str, float]) -> dict[str, Floats]:
    """Change of roll and pitch by the joints of each leg [rad]."""
    first, last = soles.up(before), soles.up(after)
    return {side: lean_of(last[side]) - lean_of(first[side]) for side in first}


def _share_risen(lean: str, before: _State, after: _State) -> float | None:
    def share(force: Floats) -> float:
        part = force[:, :2] if lean == "forward" else force[0]
        return float(part.sum() / force.sum())

    return share(after.force) - share(before.force) if before.force.any() else None


def _explain(
    soles: SoleLevel, culprit: Culprit, lean: str, before: _State, after: _State
) -> tuple[str, str]:
    """Who it is, and what to do."""
    if culprit.who == "lean":
        return "lean", "once more; left and right are those of the robot"
    if culprit.who == "imu":
        return "imu", "its mounting in the calibration is wrong: stride calibrate imu"
    if culprit.who == "cells":
        return "cells", "cells or feet are exchanged, or a scale is wrong: stride calibrate feet"
    side = culprit.who.split()[0]
    named = _mirrored(soles, side, lean, before, after)
    if named:
        return named, "turns the wrong way: stride calibrate joints"
    return culprit.who, "one of its joints is wrong: stride calibrate joints"


def _mirrored(soles: SoleLevel, side: str, lean: str, before: _State, after: _State) -> str:
    """The joint that, turned the other way, makes the leg agree; empty if it is not exactly one."""
    fitting = []
    for joint in before.angles:
        flipped = {**after.angles, joint: 2 * before.angles[joint] - after.angles[joint]}
        legs = {side: _legs(soles, before.angles, flipped)[side]}
        if joint.startswith(side) and not judge(LeanEvidence(lean, after.imu - before.imu, legs)):
            fitting.append(joint)
    return fitting[0] if len(fitting) == 1 else ""
