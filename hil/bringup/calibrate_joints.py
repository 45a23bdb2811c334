"""Joints: senses confirmed, zeros found, the range that cables allow swept; torque stays off."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hil.bringup.calibrating import Calibrating
from hil.bringup.deed import Deed
from hil.bringup.joint_signs import Angles, confirm_signs
from hil.bringup.joint_sweep import CABLES, NARROWER, STOPS, Ranges, sweep, travel
from hil.description import Joint
from hil.errors import UnknownNameError

MOST_OFFSET = np.radians(45.0)
"""A horn that is put on as near as its teeth allow is off by less: beyond, it is misplaced."""
TRAVEL_TOLERANCE = np.radians(4.0)
"""Stops and what the robot file has for a range may differ so much (assumed)."""


@dataclass(frozen=True, slots=True)
class JointsRequest:
    """What is to be done."""

    joints: tuple[str, ...] = ()
    """Only these; all that answer where there are none."""
    zero: Literal["jig", "stops"] = "jig"
    sweep: bool = True


@dataclass(frozen=True, slots=True)
class JointsResult:
    """What was found [rad], by joint."""

    offsets: Angles
    ranges: Ranges


def calibrate_joints(work: Calibrating, request: JointsRequest) -> JointsResult:
    """Ask, look, and write the file. Raises RefusedError, and nothing is written then.

    The zero is that of q = direction·(counts − 2048)/COUNTS_PER_RADIAN − offset.
    """
    joints = _chosen(work, request.joints)
    confirm_signs(work, joints)
    work.settle()
    if request.zero == "jig":
        offsets = _zero_by_jig(work, joints)
        _refuse_misplaced(work, offsets)
        ranges = sweep(work, CABLES, joints, offsets) if request.sweep else {}
    else:
        offsets, ranges = _zero_by_stops(work, joints)
        _refuse_misplaced(work, offsets)
    _compare_ranges(work, ranges)
    work.settle()
    calibration, facts = work.file.calibration, work.sampler.servo_facts()
    work.file.keep(
        "joints", f"senses by hand, zero by {request.zero}", None,
        {joint: facts[joint] for joint in joints},
        {
            "joint_offsets": calibration.joint_offsets | _rounded(offsets),
            "joint_ranges": calibration.joint_ranges
            | {joint: _within(work, joint, ends) for joint, ends in ranges.items()},
        },
    )  # fmt: skip
    return JointsResult(offsets, ranges)


def _chosen(work: Calibrating, names: tuple[str, ...]) -> list[str]:
    for name in names:
        if name not in work.description.joint_names:
            raise UnknownNameError("joint", name, work.description.joint_names)
        work.inspection.expect(name in work.joints, name, "does not answer", "stride check")
    work.settle()
    for name in work.description.joint_names:
        if name not in work.joints and not names:
            work.inspection.remark(name, "does not answer: left out")
    return [name for name in work.joints if not names or name in names]


def _rounded(offsets: Angles) -> Angles:
    return {joint: round(offset, 5) for joint, offset in offsets.items()}


def _within(work: Calibrating, joint: str, ends: tuple[float, float]) -> tuple[float, float]:
    """A swept range as it is kept: an end that is about the robot file's is the robot file's."""
    own = next(one.range for one in work.description.joints if one.name == joint)
    low = own[0] if ends[0] < own[0] + NARROWER else ends[0]
    high = own[1] if ends[1] > own[1] - NARROWER else ends[1]
    return round(low, 5), round(high, 5)


def zero_pose(joint: Joint) -> float:
    """Zero, or the end of the joint's range that is nearest to it [rad]."""
    return float(np.clip(0.0, *joint.range))


def _zero_by_jig(work: Calibrating, joints: list[str]) -> Angles:
    pose = {one.name: zero_pose(one) for one in work.description.joints}
    others = [f"{name} at {np.degrees(pose[name]):.1f}°" for name in joints if pose[name]]
    beside = f" ({', '.join(others)}: its stop)" if others else ""
    work.wait(f"Put the robot into its jig: every joint at zero{beside}", Deed(joints=pose))
    angles = work.still().angles
    for joint in joints:
        work.inspection.expect(joint in angles, joint, "does not answer any more", "its plug")
    work.settle()
    return {joint: angles[joint] - pose[joint] for joint in joints}


def _refuse_misplaced(work: Calibrating, offsets: Angles) -> None:
    for joint, offset in offsets.items():
        work.inspection.expect(
            abs(offset) <= MOST_OFFSET, joint,
            f"is off by {np.degrees(offset):+.1f}° at its zero, more than "
            f"{np.degrees(MOST_OFFSET):.0f}°: its horn is misplaced",
            "take the horn off, turn the servo to its middle (2048 counts), put it on again",
        )  # fmt: skip
    work.settle()


def _zero_by_stops(work: Calibrating, joints: list[str]) -> tuple[Angles, Ranges]:
    """Zeros from the middles between stops, which are the ends of the robot file's ranges."""
    raw = sweep(work, STOPS, joints, None)
    offsets, ranges = {}, {}
    for joint in work.description.joints:
        if joint.name not in raw:
            continue
        found, own = raw[joint.name], joint.range
        work.inspection.expect(
            abs(travel(found) - travel(own)) <= TRAVEL_TOLERANCE, joint.name,
            f"travels {np.degrees(travel(found)):.1f}° between its stops, the robot file says "
            f"{np.degrees(travel(own)):.1f}°",
            "something is in the way, or its range is not that of its stops: --zero jig",
        )  # fmt: skip
        offset = 0.5 * (sum(found) - sum(own))
        offsets[joint.name] = offset
        ranges[joint.name] = found[0] - offset, found[1] - offset
    work.settle()
    return offsets, ranges


def _compare_ranges(work: Calibrating, ranges: Ranges) -> None:
    poses = [("start", work.description.start.joints)]
    if work.description.sit is not None:
        poses.append(("sit", work.description.sit.joints))
    for joint in work.description.joints:
        if joint.name not in ranges:
            continue
        low, high = ranges[joint.name]
        if low > joint.range[0] + NARROWER or high < joint.range[1] - NARROWER:
            work.inspection.remark(
                joint.name,
                f"goes from {np.degrees(low):.1f}° to {np.degrees(high):.1f}°, the robot file "
                f"says {np.degrees(joint.range[0]):.1f}° to {np.degrees(joint.range[1]):.1f}°",
                "the driver keeps it within the narrower",
            )
        for name, pose in poses:
            angle = pose.get(joint.name, 0.0)
            work.inspection.expect(
                low - NARROWER <= angle <= high + NARROWER, joint.name,
                f"cannot reach its {name} pose of {np.degrees(angle):.1f}°",
                "free its cable, or mend the robot file",
            )  # fmt: skip
