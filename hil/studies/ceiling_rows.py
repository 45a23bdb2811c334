"""The ceilings of one gain set at one rate: the cases of `stride study ceiling`."""

from functools import lru_cache

import numpy as np
from pydantic import NonNegativeFloat, PositiveFloat, PositiveInt

from hil.compose import bus_delay_s, feasible_gains, gain_ceiling, servo_ceiling
from hil.description import RobotDescription
from hil.errors import StrideError
from hil.interface import Floats
from hil.joint_gains import GainSet, kind_of
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.studies.study import Case, Result
from hil.studies.walks import finite, walk
from hil.trace import Trace

ALL = "all"
"""In place of a joint: all gains of the set by a common factor."""
SERVO_PERIOD_S = 1e-3
"""Of the servo's own loop (assumed: ROBOTIS says only that it is fast)."""


class CeilingCase(Case):
    """The ceiling of one set of gains at the request's rate."""

    gains: tuple[tuple[str, NonNegativeFloat, NonNegativeFloat], ...]
    poses: PositiveInt
    """Of a recorded walk."""
    walk_s: PositiveFloat


def ceiling_of(case: CeilingCase) -> Result:
    """The ceilings of a set, `rows`: for a torque robot factors, for a servo robot gains."""
    description = load_robot(case.request.robot, case.request.overrides)
    gains = {joint: (kp, kd) for joint, kp, kd in case.gains}
    rate_hz = case.request.rate_hz or description.defaults.rate_hz
    request = case.request.model_copy(update={"rate_hz": None})
    trace = _poses_of(request.model_dump_json(), case.walk_s)
    if description.actuation == "servo":
        return {"rows": _servo_rows(description, gains, trace, case.poses, rate_hz)}
    ceiling = gain_ceiling(description, trace, case.poses)
    rows = [_row(ALL, None, ceiling.whole(gains, rate_hz))]
    rows += [
        _row(joint, pair, ceiling.alone(gains, joint, rate_hz)) for joint, pair in gains.items()
    ]
    return {"rows": rows}


@lru_cache(maxsize=1)
def _poses_of(request_json: str, walk_s: float) -> Trace:
    """A walk at the robot's own rate, whose poses are much the same at all others."""
    request = RunRequest.model_validate_json(request_json)
    description = load_robot(request.robot, request.overrides)
    pd = "implicit" if description.actuation == "torque" else None
    request = request.model_copy(update={"pd": pd, "duration_s": walk_s})
    walked = walk(request.resolved(description))
    if walked.stopped_s is not None:
        raise StrideError(f"{walked.ending} at {walked.stopped_s:.2f} s")
    return walked.trace


def _row(joint: str, pair: tuple[float, float] | None, factors: Floats) -> Result:
    least, typical = finite(float(factors.min())), finite(float(np.median(factors)))
    row: Result = {"joint_group": joint, "factor": least, "factor_typical": typical}
    if pair is None:
        return row
    row.update(kp=pair[0], kd=pair[1])
    if least is not None:
        row.update(kp_ceiling=least * pair[0], kd_ceiling=least * pair[1])
    return row


def _servo_rows(
    description: RobotDescription, gains: GainSet, trace: Trace, poses: int, rate_hz: int
) -> list[Result]:
    """Least ceilings of the joints of each kind, with the lightest rotor that a seed draws."""
    draws = description.plant.draws
    lightest = draws.armature[0] if draws is not None and draws.armature is not None else None
    ceiling = servo_ceiling(description, trace, poses, lightest)
    stiffness = ceiling.stiffness(SERVO_PERIOD_S)
    damping = ceiling.host_damping(rate_hz, bus_delay_s(description))
    rows = []
    for kind, (kp, kd) in gains.items():
        which = [
            index for index, name in enumerate(description.joint_names) if kind_of(name) == kind
        ]
        joint = description.joints[which[0]]
        limits = feasible_gains(joint.servo or "", joint.mode)
        own = 0.0 if limits is None or joint.mode != "position" else limits.damping[0]
        rows.append(
            {
                "joint_group": kind,
                "kp": kp,
                "kd": kd,
                "kp_ceiling": float(stiffness[which].min()),
                "kd_ceiling": own + float(damping[which].min()),
                "kp_register": None if limits is None else limits.stiffness[1],
                "kd_register": None if limits is None else limits.damping[1],
            }
        )
    return rows
