"""The walk that judges one gain set: how it is made, what is measured, and what it costs."""

from functools import lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np
from pydantic import PositiveFloat

from hil.compose.optimisations import MotionMeter, gain_objective, gain_space
from hil.description import RobotDescription
from hil.interface import Floats
from hil.joint_gains import GainSet
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Point
from hil.studies.coronal_cycle import FROUDE_SPEED
from hil.studies.gain_sets import total_of
from hil.studies.passage import Passage, pass_by
from hil.studies.study import Case, Result
from hil.validation import Config

SIGNS = (1.0, 0.0, -1.0)
"""Coronal speeds of the judged legs, times `FROUDE_SPEED`: the first author's gain study."""
LATERAL_SHARE = 0.2
"""Tolerance of a leg's coronal speed, as a share of the commanded one (ours)."""
SLACK = 1.0
"""How far the places of the reference walk are widened, in units of full penalty (ours).

Around the character's walk at 1 kHz that is 1.660 to 1.695 m of head height and 0.04 m of the
hands: the bounds of the first author's code.
"""

Side = Literal["min", "max"]


class Similar(Config):
    """What the reference walk was like, and what is still similar to it."""

    bands: dict[str, tuple[float, float]]
    """Least and largest value of each quantity of motion."""
    laterals: tuple[float, ...]
    """Mean coronal speed of each judged leg [m/s]."""


class GainCase(Case):
    """A gain set, and the walk that judges it.

    The walk goes straight for `warm_s`, then sideways at +v, 0 and −v, v/√(gL) = 0.066, for
    `leg_s` each, which is judged.
    """

    gains: GainSet
    warm_s: PositiveFloat
    leg_s: PositiveFloat

    @property
    def walk_request(self) -> RunRequest:
        """The request, as long as its legs."""
        duration_s = self.warm_s + len(SIGNS) * self.leg_s
        return self.request.model_copy(update={"duration_s": duration_s})


class CandidateCase(GainCase):
    """A candidate of a search."""

    start: GainSet
    """By which the gains are normalised."""
    side: Side
    similar: Similar
    cap: PositiveFloat | None
    """Largest ΣKp + 10·ΣKd; none for servos, which have limits of their own."""


def reference_walk(case: GainCase) -> Result:
    """What others are compared with: bands and coronal speeds, or how the walk ended early.

    With `f_speed`, the walk's own error of speed [m/s] and what is tolerated.
    """
    walked = _walk(case)
    if walked.stopped_s is not None:
        return {"stopped_s": walked.stopped_s}
    meter = _meter(case.request.robot, case.request.overrides)
    bands = {}
    for name, column in _motion(meter, case, walked).items():
        slack = SLACK * gain_objective.unit_of(name, meter.scale)
        bands[name] = (float(column.min()) - slack, float(column.max()) + slack)
    speeds, wanted = _leg_speeds(case, walked), _wanted(case)
    return {
        "stopped_s": None,
        "similar": {"bands": bands, "laterals": [lateral for _, lateral in speeds]},
        "speed": _forward(speeds),
        "wanted": wanted,
        "tolerance": gain_objective.speed_tolerance(wanted, meter.scale),
    }


def evaluate_gains(case: CandidateCase) -> Result:
    """Equation 4 of a candidate, with its parts. A set above the cap is not walked."""
    description = _robot(case.request.robot, case.request.overrides)
    total = total_of(description, case.gains)
    parts = {"gains": _size(case), "motion": 0.0, "speed": 0.0, "balance": 0.0}
    stopped_s = None
    if case.cap is not None and total > case.cap:
        parts["balance"] = 2.0 * gain_objective.BALANCE_WEIGHT * total / case.cap
    else:
        walked = _walk(case)
        stopped_s = walked.stopped_s
        parts |= _judged(case, walked)
    return {"cost": sum(parts.values()), **parts, "gain_sum": total, "stopped_s": stopped_s}


def acceptable(result: Result) -> bool:
    """Whether a walk came to its end at the right speed, with a motion that is the reference's."""
    penalties = result["motion"] + result["speed"] + result["balance"]
    return bool(penalties < gain_objective.GAINS_WEIGHT)


def legs(warm_s: float, leg_s: float, amplitude: float) -> tuple[Point, ...]:
    """The coronal command of the walk: straight, then a leg each of `SIGNS` times an amplitude."""
    points: list[Point] = [(0.0, 0.0)]
    for leg, sign in enumerate(SIGNS):
        begin = warm_s + leg * leg_s
        points += [(begin, points[-1][1]), (begin, sign * amplitude)]
    return tuple(points)


def lateral_speed(speed_scale: float) -> float:
    """Commanded coronal speed of a robot with √(gL) = `speed_scale` [m/s]."""
    return FROUDE_SPEED * speed_scale


def _size(case: CandidateCase) -> float:
    gains = [gain for pair in case.gains.values() for gain in pair]
    start = [gain for pair in case.start.values() for gain in pair]
    return gain_objective.f_gains(gains, start, case.side == "max")


def _judged(case: CandidateCase, walked: Passage) -> Result:
    """Motion, speed and balance of a walk."""
    request = case.walk_request
    if walked.stopped_s is not None:
        return {"balance": gain_objective.f_balance(walked.stopped_s, request.duration_s)}
    meter = _meter(request.robot, request.overrides)
    motion = _motion(meter, case, walked)
    speeds = _leg_speeds(case, walked)
    wanted = _wanted(case)
    tolerance = gain_objective.speed_tolerance(wanted, meter.scale)
    speed = gain_objective.f_speed(_forward(speeds), wanted, tolerance)
    sideways = LATERAL_SHARE * max(abs(value) for _, value in request.schedules.lateral)
    for (_, lateral), reference in zip(speeds, case.similar.laterals, strict=True):
        speed += gain_objective.f_speed(lateral, reference, sideways)
    return {
        "motion": gain_objective.f_motion(motion, case.similar.bands, meter.scale),
        "speed": speed,
    }


def _walk(case: GainCase) -> Passage:
    request = case.walk_request
    description = _robot(request.robot, request.overrides)
    rate_hz = request.rate_hz or description.defaults.rate_hz
    return pass_by(request, gain_space.with_gains(description, rate_hz, case.gains))


def _motion(meter: MotionMeter, case: GainCase, passage: Passage) -> dict[str, Floats]:
    judged = slice(int(np.searchsorted(passage.time_s, case.warm_s)), None)
    return meter.measure(
        passage.base_position[judged],
        passage.base_orientation[judged],
        passage.joint_position[judged],
        passage.heading[judged],
    )


def _leg_speeds(case: GainCase, passage: Passage) -> list[tuple[float, float]]:
    """Mean sagittal and coronal speed of each judged leg, in the heading frame [m/s]."""
    cos, sin = np.cos(passage.heading), np.sin(passage.heading)
    vx, vy = passage.com_velocity[:, 0], passage.com_velocity[:, 1]
    forward, left = cos * vx + sin * vy, cos * vy - sin * vx
    ends = [case.warm_s + leg * case.leg_s for leg in range(len(SIGNS) + 1)]
    ticks = np.searchsorted(passage.time_s, ends)
    return [
        (float(forward[begin:end].mean()), float(left[begin:end].mean()))
        for begin, end in pairwise(ticks.tolist())
    ]


def _forward(speeds: list[tuple[float, float]]) -> float:
    return float(np.mean([sagittal for sagittal, _ in speeds]))


def _wanted(case: GainCase) -> float:
    """Commanded sagittal speed at the end of the walk [m/s]."""
    default = _robot(case.request.robot, case.request.overrides).defaults.speed
    return (case.request.schedules.speed or ((0.0, default),))[-1][1]


@lru_cache(maxsize=4)
def _robot(robot: str, overrides: tuple[str, ...]) -> RobotDescription:
    return load_robot(robot, overrides)


@lru_cache(maxsize=4)
def _meter(robot: str, overrides: tuple[str, ...]) -> MotionMeter:
    return MotionMeter(_robot(robot, overrides))
