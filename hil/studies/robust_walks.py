"""The walks of `stride study robustness`: one condition, one robot, and what came of it."""

import numpy as np
from pydantic import PositiveFloat, PositiveInt

from hil.gait_report import flat_mid_stance, heading_error
from hil.robot_facts import body_weight
from hil.robot_files import load_robot
from hil.schedule import Push
from hil.studies.pushes import DIRECTIONS, PhaseCase, time_two_steps
from hil.studies.servo_loads import ServoLoads
from hil.studies.study import Case, Result
from hil.studies.walks import Walk, finite, mean_velocity, walk

EMPTY: Result = dict.fromkeys(
    (
        "condition",
        "rate_hz",
        "seed",
        "survived",
        "ending",
        "stopped_s",
        "steps",
        "speed_error_mps",
        "speed_error_pct",
        "sideways_mps",
        "heading_error_deg",
        "flat_pct",
        "saturation_pct",
        "saturated_joint",
        "torque_rms_pct",
        "loaded_joint",
        "temperature_max_c",
        "minutes_to_70c",
        "pushes",
        "pushes_survived",
        "fell_when_pushed",
        "error",
    )
)
"""Columns of the CSV."""


class RobustCase(Case):
    """One walk; the request holds its command, its robot and its time."""


class PushedCase(Case):
    """A walk for every direction and phase, each with one push."""

    directions: tuple[str, ...]
    force: PositiveFloat
    """[N]"""
    push_s: PositiveFloat
    phases: PositiveInt
    """Equally spaced over two steps."""
    settle_s: PositiveFloat
    follow_s: PositiveFloat


def robust_walk(case: RobustCase) -> Result:
    """Survival, speeds, contact, saturation, torque and heat of one walk."""
    description = load_robot(case.request.robot, case.request.overrides)
    loads = ServoLoads(description)
    walked = walk(case.request, loads)
    saturated, saturation = loads.saturated()
    loaded, rms = loads.rms()
    report = walked.report
    return {
        "survived": walked.stopped_s is None,
        "ending": walked.ending,
        "stopped_s": walked.stopped_s,
        "steps": report["steps"],
        **(_speeds(walked) if walked.stopped_s is None else {}),
        "flat_pct": flat_mid_stance(walked.trace, body_weight(description)),
        # Frames tell which joint is the worst; how bad it is, the simulated servos know better
        # than samples of them once a tick.
        "saturation_pct": _first(report["duty_saturation_pct_max"], 1.0, saturation),
        "saturated_joint": saturated,
        "torque_rms_pct": _first(report["torque_rms_ratio_max"], 100.0, rms),
        "loaded_joint": loaded,
        "temperature_max_c": report["temperature_max_c"],
        "minutes_to_70c": None if loads.hot_s is None else loads.hot_s / 60.0,
    }


def _speeds(walked: Walk) -> Result:
    """Errors of the mean speeds over whole strides, against the command in the end."""
    trace = walked.trace
    if len(trace) < 2:
        return {}
    forward, left = mean_velocity(trace)
    wanted, sideways = float(trace.speed[-1]), float(trace.lateral[-1])
    along, wanted = (left, sideways) if sideways else (forward, wanted)
    error = along - wanted
    return {
        "speed_error_mps": finite(error),
        "speed_error_pct": finite(100.0 * error / abs(wanted) if wanted else np.nan),
        "sideways_mps": finite(forward if sideways else left),
        "heading_error_deg": finite(heading_error(trace)),
    }


def _first(value: float | None, scale: float, other: float) -> float:
    return other if value is None else scale * value


def robust_pushes(case: PushedCase) -> Result:
    """How many of the pushes were survived, and which ones were not."""
    timing = PhaseCase(request=case.request, settle_s=case.settle_s, duration_s=case.settle_s + 3.0)
    steps = time_two_steps(timing)
    begin, span = steps["begin_s"], steps["end_s"] - steps["begin_s"]
    fell = []
    for name in case.directions:
        for phase in range(case.phases):
            start = begin + span * phase / case.phases
            x, y = DIRECTIONS[name]
            push = Push(
                force=(case.force * x, case.force * y, 0.0), start=start, duration=case.push_s
            )
            schedules = case.request.schedules.model_copy(update={"pushes": (push,)})
            end_s = start + case.push_s + case.follow_s
            request = case.request.model_copy(update={"schedules": schedules, "duration_s": end_s})
            if walk(request).stopped_s is not None:
                fell.append(f"{name} {2.0 * phase / case.phases:.2f}")
    count = len(case.directions) * case.phases
    return {
        "survived": not fell,
        "pushes": count,
        "pushes_survived": count - len(fell),
        "fell_when_pushed": ", ".join(fell) or None,
    }
