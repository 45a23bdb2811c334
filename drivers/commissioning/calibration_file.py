"""The calibration file of a robot while its parts are measured one after another."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from drivers.boards.calibration import FootCalibration, ImuCalibration
from drivers.calibration import (
    Provenance,
    RobotCalibration,
    load_calibration,
    save_calibration,
)
from hil.description import RobotDescription
from hil.errors import DescriptionError

Part = Literal["joints", "imu", "feet", "lean"]


class CalibrationFile:
    """What the file holds, or an empty calibration where there is none yet."""

    def __init__(self, description: RobotDescription, out: Path | None, software: str) -> None:
        """`out`: instead of the file that the robot file names. Raises InputError."""
        if out is None and description.calibration is None:
            raise DescriptionError(
                description.file, "calibration",
                "is missing: write `calibration: FILE.yaml` there, or give --out FILE.yaml",
            )  # fmt: skip
        beside = Path(description.file).parent / (description.calibration or "")
        self.path = out or beside
        self._software = software
        if self.path.is_file():
            self.calibration = load_calibration(self.path)
        else:
            now = Provenance(date=_today(), method="stride calibrate", software=software)
            self.calibration = RobotCalibration(robot=description.name, provenance=now)
        if self.calibration.robot != description.name:
            raise DescriptionError(
                str(self.path), "robot",
                f"is for {self.calibration.robot!r}, the robot is {description.name!r}",
            )  # fmt: skip

    def keep(
        self, part: Part, method: str, residual: float | None, parts: dict[str, str],
        changes: dict[str, Any],
    ) -> None:  # fmt: skip
        """Write one part's values and where they come from, all at once. Raises InputError."""
        before = self.calibration.measured.get(part)
        known = before.parts if before is not None else {}
        record = Provenance(
            date=_today(), method=method, software=self._software, residual=residual,
            parts=known | parts,
        )  # fmt: skip
        top = self.calibration.provenance.model_copy(
            update={"date": _today(), "software": self._software}
        )
        measured = {**self.calibration.measured, part: record}
        self.calibration = self.calibration.model_copy(
            update={**changes, "measured": measured, "provenance": top}
        )
        save_calibration(self.calibration, self.path)

    def keep_feet(
        self,
        feet: Mapping[str, Mapping[str, object]],
        method: str,
        residual: float,
        parts: dict[str, str],
    ) -> None:
        """Write zeros and scales by side. Raises InputError."""
        found = {side: FootCalibration.model_validate(foot) for side, foot in feet.items()}
        self.keep("feet", method, residual, parts, {"feet": {**self.calibration.feet, **found}})

    def keep_imu(
        self, mounting: Sequence[float], gyro_bias: Sequence[float], method: str, residual: float
    ) -> None:
        """Write mounting and bias. Raises InputError."""
        imu = ImuCalibration.model_validate(
            {"mounting": tuple(mounting), "gyro_bias": tuple(gyro_bias)}
        )
        self.keep("imu", method, residual, {}, {"imu": imu})


def _today() -> datetime.date:
    return datetime.datetime.now(datetime.UTC).date()
