"""Does the calibration belong to the robot, and is it whole?"""

import numpy as np

from drivers.calibration import RobotCalibration
from hil.bringup.facts import Inspection
from hil.description import RobotDescription
from hil.errors import InputError

_WHERE = "calibration"


def look_at_calibration(
    description: RobotDescription, calibration: RobotCalibration | None, inspection: Inspection
) -> None:
    """Missing, somebody else's, half done, never leant; ranges that are narrower than described."""
    if calibration is None:
        if description.calibration is None:
            inspection.remark(_WHERE, "the robot file names none: joint zeros count as 0",
                              "a walk of a real robot needs one")  # fmt: skip
        else:
            inspection.expect(False, _WHERE, f"there is no file {description.calibration} yet",
                              "stride calibrate joints, imu, feet, lean")  # fmt: skip
        return
    gaps = calibration.gaps(description)
    inspection.expect(not gaps, _WHERE, f"not measured yet: {', '.join(gaps)}", "stride calibrate")
    if gaps:
        return
    try:
        calibration.check_against(description)
    except InputError as error:
        inspection.expect(False, _WHERE, str(error))
        return
    if calibration.measured and calibration.agreed != calibration.identity():
        inspection.remark(_WHERE, "nobody has leant the robot with these values",
                          "stride calibrate lean")  # fmt: skip
    _look_at_ranges(description, calibration, inspection)


def _look_at_ranges(
    description: RobotDescription, calibration: RobotCalibration, inspection: Inspection
) -> None:
    low, high = np.degrees(calibration.ranges(description))
    for index, joint in enumerate(description.joints):
        if joint.name in calibration.joint_ranges:
            own = np.degrees(joint.range)
            if low[index] > own[0] or high[index] < own[1]:
                inspection.remark(
                    joint.name,
                    f"is kept within {low[index]:.1f}° to {high[index]:.1f}° by its calibration, "
                    f"the robot file says {own[0]:.1f}° to {own[1]:.1f}°",
                )
