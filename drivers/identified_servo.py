"""Identified servos: which can be, and how they get into the robot's calibration file."""

from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

from drivers.calibration import (
    RobotCalibration,
    ServoCalibration,
    load_calibration,
    save_calibration,
)
from drivers.dynamixel.servo_models import servo_model_of
from hil.description import Joint, RobotDescription
from hil.errors import InputError


def require_identifiable(joint: Joint) -> None:
    """Raises InputError for a joint whose servo measures no motor current."""
    model = servo_model_of(joint)
    if model.current_unit is None or model.current_sensing == "supply":
        raise InputError(
            f"joint {joint.name}: {model.name} does not measure its motor's current, from which "
            "identify works"
        )


def keep_identified(
    description: RobotDescription,
    calibration: RobotCalibration,
    path: Path,
    joint: str,
    constants: Mapping[str, object],
    method: str,
) -> None:
    """Write a joint's constants into a calibration file, made of `calibration` if there is none.

    Raises InputError or DescriptionError for a file of another robot or one that is no file.
    """
    if path.is_file():
        calibration = load_calibration(path)
    calibration.check_against(description, str(path))
    servo = ServoCalibration.model_validate(
        {**constants, "date": datetime.now(UTC).date(), "method": method}
    )
    servos = calibration.servos | {joint: servo}
    save_calibration(calibration.model_copy(update={"servos": servos}), path)
