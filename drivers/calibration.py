"""Calibration of one robot: what a description cannot know, in a file of its own.

A calibration belongs to one individual robot and says where it comes from; a run that drives
hardware refuses one whose robot, joints or feet do not match the description.
"""

import datetime
import hashlib
import json
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Literal

import numpy as np
import yaml
from pydantic import Field, PositiveFloat

from drivers.boards.calibration import FootCalibration, ImuCalibration
from hil.description import RobotDescription
from hil.errors import DescriptionError, InputError
from hil.interface import Floats
from hil.validation import Config, read_yaml, validate


class Provenance(Config):
    """Where a calibration comes from."""

    date: datetime.date
    """ISO date, quoted or not."""
    method: str
    """How it was measured, or "ideal" for a virtual robot."""
    operator: str = ""
    serial: str = ""
    """Serial number of the robot."""
    residual: float | None = None
    """Root mean square error of the fit: load cells [N], tilts of the IMU [rad]."""
    software: str = ""
    """Version of the program that measured, with its commit where there is one."""
    parts: dict[str, str] = Field(default_factory=dict)
    """Servos and boards that were measured: model, id and firmware, by joint or board."""


class ServoCalibration(Config):
    """What `stride identify` found of one joint's servo, at the output shaft.

    The driver uses the motor's constants and the divisor; the rest is for simulations and for
    whoever wants to know. Every value has a standard deviation in `deviation`, by key.
    """

    torque_constant: PositiveFloat
    """k_t = back-EMF constant [N·m/A = V·s/rad]."""
    resistance: PositiveFloat
    """[Ω]"""
    gain_divisor: PositiveFloat
    """Position P Gain register units per internal unit."""
    armature: float = Field(ge=0)
    """Reflected rotor inertia [kg·m²]."""
    friction: float = Field(ge=0)
    """Dry friction [N·m]."""
    viscous: float = Field(ge=0)
    """Friction per speed, without back-EMF [N·m·s/rad]."""
    delay: float = Field(ge=0)
    """From sending a goal to its effect [s]."""
    backlash: float = Field(ge=0)
    """Full gap [rad]."""
    deviation: dict[str, float] = Field(default_factory=dict)
    residual: float | None = None
    """Root mean square of torque left over by the fit [N·m]."""
    date: datetime.date
    method: str
    """Tests, and whether the servo was real or virtual."""


class RobotCalibration(Config):
    """Joint offsets, servos, load cells and IMU mounting of one robot."""

    robot: str
    """Name in the robot description."""
    provenance: Provenance
    joint_offsets: dict[str, float] = Field(default_factory=dict)
    """Servo-frame angle at which the joint is zero [rad], by joint; 0 for joints not named.
    q = direction·(counts − 2048)/COUNTS_PER_RADIAN − offset."""
    servos: dict[str, ServoCalibration] = Field(default_factory=dict)
    """Identified servos by joint; the data sheet's constants for joints not named."""
    feet: dict[Literal["left", "right"], FootCalibration] = Field(default_factory=dict)
    imu: ImuCalibration = ImuCalibration()
    joint_ranges: dict[str, tuple[float, float]] = Field(default_factory=dict)
    """How far cables and parts let a joint go, swept by hand [rad], by joint."""
    measured: dict[Literal["joints", "imu", "feet", "lean"], Provenance] = Field(
        default_factory=dict
    )
    """When and how each part was measured last."""
    agreed: str = ""
    """`identity` of the values with which leaning found joints, IMU and cells to agree."""

    def identity(self) -> str:
        """What distinguishes the values that a driver applies: 16 hexadecimal digits.

        The same for the same values, whenever, however and in whatever order they were written;
        another one after any change of an offset, range, servo, cell or mounting.
        """
        applied = self.model_dump(mode="json", exclude={"provenance", "measured", "agreed"})
        for servo in applied["servos"].values():
            for key in ("date", "method", "deviation", "residual"):
                del servo[key]
        text = json.dumps(applied, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def ranges(self, description: RobotDescription) -> Floats:
        """Lowest and highest angle of every joint [rad], (2, n): the narrower of the robot file's
        range and of what was swept."""
        rows = [(joint.range, self.joint_ranges.get(joint.name, joint.range))
                for joint in description.joints]  # fmt: skip
        return np.array([[max(a[0], b[0]) for a, b in rows], [min(a[1], b[1]) for a, b in rows]])

    def gaps(self, description: RobotDescription) -> tuple[str, ...]:
        """What of a robot `stride calibrate` has not measured, in words; none for a calibration
        that was not made by it, such as a virtual robot's."""
        if not self.measured:
            return ()
        known = self.measured["joints"].parts if "joints" in self.measured else {}
        gaps = [f"joint {name}" for name in description.joint_names if name not in known]
        if description.imu is not None and "imu" not in self.measured:
            gaps.append("imu")
        gaps += [f"{side} foot" for side, foot in description.feet.items()
                 if foot.board is not None and side not in self.feet]  # fmt: skip
        return tuple(gaps)

    def require_whole(self, description: RobotDescription, file: str = "calibration") -> None:
        """Raises DescriptionError when it does not fit the robot, or was only begun."""
        gaps = self.gaps(description)
        if gaps:
            raise DescriptionError(
                file, "measured", f"not yet: {', '.join(gaps)} (stride calibrate)"
            )
        self.check_against(description, file)

    def offsets(self, joint_names: tuple[str, ...]) -> Floats:
        """Offsets in joint order [rad], shape (n,)."""
        return np.array([self.joint_offsets.get(name, 0.0) for name in joint_names])

    def check_against(self, description: RobotDescription, file: str = "calibration") -> None:
        """Raises DescriptionError when it does not fit the robot."""
        if self.robot != description.name:
            raise DescriptionError(
                file, "robot", f"is for {self.robot!r}, the robot is {description.name!r}"
            )
        for key, named in (
            ("joint_offsets", self.joint_offsets),
            ("joint_ranges", self.joint_ranges),
            ("servos", self.servos),
        ):
            strangers = sorted(set(named) - set(description.joint_names))
            if strangers:
                valid = ", ".join(description.joint_names)
                raise DescriptionError(
                    file, key, f"no joint {', '.join(strangers)}; valid: {valid}"
                )
        for side, foot in description.feet.items():
            if foot.board is not None and side not in self.feet:
                raise DescriptionError(file, f"feet.{side}", "is missing: the foot has load cells")


def load_calibration(path: Path) -> RobotCalibration:
    """Read a calibration file. Raises InputError or DescriptionError, naming file and key."""
    return validate(RobotCalibration, read_yaml(path), str(path))


def save_calibration(calibration: RobotCalibration, path: Path) -> None:
    """Write a calibration file whole or not at all. Raises InputError."""
    text = yaml.safe_dump(calibration.model_dump(mode="json"), sort_keys=False)
    try:
        number, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.resolve().parent)
        try:
            with os.fdopen(number, "w", encoding="utf-8") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            Path(name).chmod(0o644)
            Path(name).replace(path)
        except BaseException:
            with suppress(OSError):
                Path(name).unlink()
            raise
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
