"""`stride new-robot` as a function: one model in, one robot folder out."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import mujoco
import yaml

from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import SIDES
from hil.new_robot.findings import Finding, findings_of
from hil.new_robot.gait import fitted
from hil.new_robot.joints import Drive, joint_lines
from hil.new_robot.limbs import find_legs
from hil.new_robot.links import links_of
from hil.new_robot.mjcf import write_mjcf
from hil.new_robot.posture import zero_pose
from hil.new_robot.robot_yaml import RobotFile
from hil.new_robot.roles import roles_of
from hil.new_robot.similar import scale_of
from hil.new_robot.sitting import sitting
from hil.new_robot.soles import sole_of
from hil.new_robot.source import read_source
from hil.validation import validate


@dataclass(frozen=True, slots=True)
class NewRobot:
    """What was written, and what is to be known of it."""

    file: Path
    """The robot file."""
    findings: tuple[Finding, ...]


def new_robot(model_file: Path, name: str, folder: Path, drive: Drive) -> NewRobot:
    """Write `folder`/name.yaml and name.xml.

    Raises InputError for a model that cannot be driven, or a folder that has such files; nothing
    is written then.
    """
    paths = folder / f"{name}.yaml", folder / f"{name}.xml"
    there = [str(path) for path in paths if path.exists()]
    if there:
        raise InputError(f"{there[0]} exists: give another --name or --out")
    source = read_source(model_file)
    legs = find_legs(source)
    posture = zero_pose(source, legs, roles_of(source, legs))
    links = links_of(posture)
    feet = [f"{side}_{leg.roled.joints[-1].role}"
            for side, leg in zip(SIDES, posture.legs, strict=True)]  # fmt: skip
    left, right = (
        sole_of(model_file, posture, leg, links[foot], foot.split("_", 1)[0])
        for leg, foot in zip(posture.legs, feet, strict=True)
    )
    mass = sum(link.mass for link in links.values())
    scale = scale_of(mass, posture.legs[0].length)
    joints = joint_lines(source, posture, scale, drive)
    by_name = {joint.name: joint for joint in joints}
    mjcf = write_mjcf(model_file.name, name, posture, links, (left, right), by_name)
    fit = fitted(posture, (left, right))
    sit = sitting(mjcf, by_name)
    text = RobotFile(name, model_file.name, mass, scale, posture, fit, joints, sit, drive).text()
    _prove(model_file, mjcf, text, str(paths[0]))
    _write(folder, dict(zip(paths, (text, mjcf), strict=True)))
    found = findings_of(
        source, legs, posture, (left, right), joints, fit, scale, drive, sit is not None
    )
    return NewRobot(paths[0], found)


def _write(folder: Path, texts: dict[Path, str]) -> None:
    """All files or none: half a robot would be in the way of the next try."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path, content in texts.items():
            path.write_text(content, encoding="utf-8")
    except OSError as error:
        for path in texts:
            with suppress(OSError):
                path.unlink()
        raise InputError(f"--out {folder}: cannot be written: {error.strerror}") from error


def _prove(model_file: Path, mjcf: str, text: str, file: str) -> None:
    """Both texts are read back before anything is written."""
    try:
        mujoco.MjModel.from_xml_string(mjcf)
    except ValueError as error:
        problem = " ".join(str(error).split())
        raise InputError(f"{model_file}: masses make no model that moves: {problem}") from error
    validate(RobotDescription, {**yaml.safe_load(text), "file": file}, file)
