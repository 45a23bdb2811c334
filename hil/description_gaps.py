"""What a robot file still lacks or has wrong, by the rung that needs it, with what to do."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import mujoco
from pydantic import ValidationError

from hil.compose import feasible_gains, servo_facts
from hil.description import Joint, RobotDescription
from hil.errors import UnknownNameError
from hil.interface import SIDES
from hil.robot_files import find_robot_file
from hil.validation import mistakes, read_yaml

CALIBRATE = "stride calibrate joints, imu and feet write it (docs/calibration.md)"
Rung = Literal["any walk", "dry run", "real robot"]
"""The lowest rung that needs it; those above need it too."""

MARGIN = 1.01
"""Rounding that a limit of the file may have above the data sheet's."""


@dataclass(frozen=True, slots=True)
class Gap:
    """One thing that is missing or wrong."""

    where: str
    what: str
    needed_for: Rung
    advice: str


def description_gaps(robot: str) -> list[Gap]:
    """Everything that is missing in a robot's file, lowest rung first.

    Raises InputError for a file that is not there or is no YAML.
    """
    path = find_robot_file(robot)
    data = {**read_yaml(path), "file": str(path)}
    try:
        description = RobotDescription.model_validate(data)
    except ValidationError as error:
        found = mistakes(RobotDescription, error)
        return [Gap(key, what, "any walk", _mend(what)) for key, what in found]
    gaps = [*_model_gaps(description), *_start_gaps(description)]
    if description.actuation == "servo":
        gaps += [gap for joint in description.joints for gap in _joint_gaps(joint)]
        gaps += [*_sensor_gaps(description), *_wire_gaps(description)]
    order: tuple[Rung, ...] = ("any walk", "dry run", "real robot")
    return sorted(gaps, key=lambda gap: order.index(gap.needed_for))


def _mend(what: str) -> str:
    if what == "is missing":
        return "write it; `stride new-robot` writes every key, minibiped.yaml explains them"
    return "remove or correct it" if "unknown key" in what else "correct it"


def _model_gaps(description: RobotDescription) -> Iterator[Gap]:
    """Parts that the file names and the MJCF has not."""
    path = description.model_path
    if not path.is_file():
        yield Gap("model", f"no such file: {path}", "any walk", "name the MJCF beside this file")
        return
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        problem = " ".join(str(error).split())
        yield Gap("model", f"MuJoCo cannot read it: {problem}", "any walk", "mend the MJCF")
        return
    kinds = mujoco.mjtObj
    feet = description.feet.items()
    named = [
        ("root", kinds.mjOBJ_BODY, description.root),
        *((f"joints.{name}", kinds.mjOBJ_JOINT, name) for name in description.joint_names),
        *((f"feet.{side}.body", kinds.mjOBJ_BODY, foot.body) for side, foot in feet),
        *((f"feet.{side}.sole", kinds.mjOBJ_GEOM, foot.sole) for side, foot in feet),
        *((f"feet.{side}.ankle", kinds.mjOBJ_JOINT, foot.ankle) for side, foot in feet),
    ]
    if description.imu is not None:
        named.append(("imu.site", kinds.mjOBJ_SITE, description.imu.site))
    for where, kind, name in named:
        if mujoco.mj_name2id(model, kind, name) < 0:
            what = kind.name.removeprefix("mjOBJ_").lower()
            yield Gap(where, f"no {what} {name!r} in {path.name}", "any walk", "use its name there")


def _start_gaps(description: RobotDescription) -> Iterator[Gap]:
    poses = {"start": description.start.joints}
    if description.sit is not None:
        poses["sit"] = description.sit.joints
    elif description.actuation == "servo":
        yield Gap(
            "sit", "is missing: a stop switches torque off standing", "real robot",
            "a pose on bent legs, centre of mass over the soles; try it with stride sit on a hoist",
        )  # fmt: skip
    for key, pose in poses.items():
        for joint in description.joints:
            angle = pose.get(joint.name)
            low, high = joint.range
            if angle is not None and not low <= angle <= high:
                yield Gap(
                    f"{key}.joints.{joint.name}", f"{angle:g} rad is outside {low:g} to {high:g}",
                    "any walk", "another pose, or the joint's true range",
                )  # fmt: skip


def _joint_gaps(joint: Joint) -> Iterator[Gap]:
    where = f"joints.{joint.name}"
    if joint.servo is None:
        yield Gap(
            f"{where}.servo", "not filled in", "dry run", "its model; stride gains lists them"
        )
    else:
        yield from _servo_gaps(where, joint, joint.servo)
    if joint.bus is None:
        yield Gap(f"{where}.bus", "not filled in", "dry run", "one of the names under buses")
    if joint.id is None:
        yield Gap(
            f"{where}.id", "not filled in", "dry run",
            "0 to 252, one of its own on the bus; stride scan finds them, stride setup sets them",
        )  # fmt: skip


def _servo_gaps(where: str, joint: Joint, servo: str) -> Iterator[Gap]:
    try:
        limits = feasible_gains(servo, joint.mode)
    except UnknownNameError as error:
        yield Gap(f"{where}.servo", f"unknown {servo!r}", "any walk", f"{', '.join(error.valid)}")
        return
    facts = servo_facts(servo)
    for key, value, most in (
        ("torque_limit", joint.torque_limit, facts["stall_torque"]),
        ("velocity_limit", joint.velocity_limit, facts["no_load_speed"]),
    ):
        if value > MARGIN * most:
            yield Gap(
                f"{where}.{key}", f"{value:g} is more than a {servo} has", "any walk",
                f"{most:.3g} at most (its data sheet, at {facts['voltage']:g} V)",
            )  # fmt: skip
    if limits is None:
        yield Gap(f"{where}.mode", f"{servo} has no mode {joint.mode}", "any walk", "position")
        return
    for key, value, (low, high) in (
        ("stiffness", joint.stiffness, limits.stiffness),
        ("damping", joint.damping, limits.damping),
    ):
        if not low <= value <= high:
            yield Gap(
                f"{where}.{key}", f"{value:g} is not what a {servo} can do", "any walk",
                f"{low:.3g} to {high:.3g} (stride gains {servo})",
            )  # fmt: skip


def _sensor_gaps(description: RobotDescription) -> Iterator[Gap]:
    for side in SIDES:
        if description.feet[side].board is None:  # type: ignore[index]
            yield Gap(f"feet.{side}.board", "no board: its forces are not known", "any walk",
                      "a foot board (docs/foot-board.md)")  # fmt: skip
    if description.imu is None:
        yield Gap("imu", "is missing: the attitude is not known", "any walk",
                  "board and site of an IMU (docs/frames.md)")  # fmt: skip


def _wire_gaps(description: RobotDescription) -> Iterator[Gap]:
    advice = "stride scan finds ports; write it, or give --port NAME=DEVICE"
    for kind, parts in (("buses", description.buses), ("boards", description.boards)):
        for name, part in parts.items():
            if part.port is None:
                yield Gap(f"{kind}.{name}.port", "not filled in", "real robot", advice)
    if not description.buses:
        yield Gap("buses", "none", "dry run", "one entry for each USB adapter, as in minibiped")
    calibration = description.calibration
    if calibration is None:
        yield Gap("calibration", "is missing", "real robot",
                  CALIBRATE)  # fmt: skip
    elif not (Path(description.file).parent / calibration).is_file():
        yield Gap("calibration", f"no such file: {calibration}", "real robot",
                  CALIBRATE)  # fmt: skip
