"""How much the joints of a walk vibrate with the control period."""

import numpy as np

from hil.robot_files import load_robot
from hil.studies.study import Case, Result
from hil.studies.walks import walk


class VibrationCase(Case):
    """A walk; its request holds the gains."""


def vibration_of(case: VibrationCase) -> Result:
    """The largest vibration of a joint in a walk, and how the walk ended.

    A joint rate that alternates, ω = ±A by turns, has second differences of 4·A. Vibration is the
    root mean square of a quarter of them, over the walk but its first quarter [rad/s].
    """
    walked = walk(case.request)
    rate_hz = case.request.rate_hz or 1
    second = np.diff(walked.trace.joint_position, 3, axis=0) * rate_hz / 4.0
    quarter = len(second) // 4
    if quarter == 0:
        return {"vibration": None, "joint": None, "ending": walked.ending}
    rms = np.sqrt(np.mean(np.square(second[quarter:]), axis=0))
    names = load_robot(case.request.robot).joint_names
    worst = int(np.argmax(rms))
    return {
        "vibration": float(rms[worst]),
        "joint": names[worst],
        "ending": walked.ending,
    }
