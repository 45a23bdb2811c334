"""The walks that judge a candidate of the gait search, and what they cost."""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from pydantic import Field, PositiveFloat, PositiveInt

from hil.compose import build
from hil.compose.optimisations import drag_meter, style_space
from hil.compose.optimisations import gait_objective as objective
from hil.cycle import TickRecord
from hil.interface import Floats
from hil.robot_facts import RobotFacts, robot_facts
from hil.robot_files import load_robot
from hil.schedule import Push
from hil.session import Session
from hil.studies.pushes import DIRECTIONS
from hil.studies.study import Case, Result
from hil.studies.walks import finite, mean_velocity, walk_session

PUSH_S = 0.3
PUSH_EVERY = 7.5
"""Time from one push to the next, in √(L/g): some four steps, so that phases differ."""
FIRST_FROUDE, FROUDE_STEP = 0.134, 0.019
"""The first of the growing pushes and what each next one adds, as Δv/√(gL)."""
AROUND = ("left", "forward", "right", "back")


class GaitCase(Case):
    """A candidate and the walks that judge it: every seed at every rate."""

    changes: tuple[str, ...]
    """`KEY=VALUE` of the candidate."""
    rates_hz: tuple[PositiveInt, ...] = Field(min_length=1)
    seeds: tuple[int, ...] = Field(min_length=1)
    """Robots: a seed draws what a simulated robot hides."""
    warm_s: PositiveFloat
    judged_s: PositiveFloat
    pushes: int = Field(ge=0)
    """Growing pushes after the judged time."""
    weights: dict[str, float]
    start: dict[str, float]
    """Terms of the start; empty when it is the start that is judged."""
    speed_tolerance: PositiveFloat
    """Share of the commanded speed."""


class MotionLog:
    """A sink: torques, joint positions, Δ, drag and recovery steps of the judged ticks."""

    def __init__(self, begin_s: float, end_s: float, session: Session) -> None:
        self._begin_s, self._end_s = begin_s, end_s
        self._session = session
        wet = bool(session.request.schedules.water)
        self._measure: Callable[[], float] = drag_meter(session) if wet else float
        self._drag: list[float] = []
        self._recovering: list[bool] = []
        self._torque: list[Floats] = []
        self._joints: list[Floats] = []
        self._alteration: list[float] = []

    def put(self, record: TickRecord) -> None:
        """Take one tick, if it is judged."""
        if self._begin_s <= record.time_s < self._end_s:
            self._torque.append(record.frame.joint_torque.copy())
            self._joints.append((record.truth or record.estimate).joint_position.copy())
            self._alteration.append(record.status.alteration)
            self._drag.append(self._measure())
            self._recovering.append(record.status.recovering)

    @property
    def recovery(self) -> float:
        """Share of the judged ticks that belong to recovery steps."""
        return float(np.mean(self._recovering)) if self._recovering else 0.0

    def terms(self, rate_hz: float, facts: RobotFacts) -> Result | None:
        """Terms of the objective and the factor of Δ; None for too few ticks."""
        if len(self._torque) < 3:
            return None
        motion = objective.GaitMotion(
            rate_hz,
            np.array(self._torque),
            np.array(self._joints),
            np.array(self._alteration),
            np.array(self._drag),
            facts.leg_length / objective.LEG_OF_THE_LIMIT_M,
            reference_acceleration(self._session),
        )
        return {"alteration": objective.alteration_factor(motion), **objective.terms_of(motion)}


def reference_acceleration(session: Session) -> float | None:
    """Of the poses that a torque robot is asked for at the end of the walk; None for others."""
    description, schedules = session.description, session.request.schedules
    if description.actuation == "servo":
        return None
    speed = schedules.speed[-1][1] if schedules.speed else description.defaults.speed
    level = schedules.water[-1][1] if schedules.water else 0.0
    return style_space.reference_acceleration(description, speed, level)


def gait_cost(case: GaitCase) -> Result:
    """`cost` of a candidate and its parts: means over seeds and rates."""
    parts = [_walked(case, rate_hz, seed) for rate_hz in case.rates_hz for seed in case.seeds]
    names = list(dict.fromkeys(name for part in parts for name in part))
    found: Result = {
        name: float(np.mean([part[name] for part in parts if name in part])) for name in names
    }
    found["fallen"] = sum(part["walked"] < 1.0 for part in parts)
    return found


def _walked(case: GaitCase, rate_hz: int, seed: int) -> dict[str, float]:
    """Cost and terms of one walk."""
    facts = _facts(case.request.robot)
    end_s = case.warm_s + case.judged_s
    pushes = growing_pushes(facts, end_s, case.pushes)
    duration_s = end_s + (case.pushes * PUSH_EVERY + PUSH_EVERY) * facts.time_scale * bool(pushes)
    request = case.request.model_copy(
        update={
            "rate_hz": rate_hz,
            "seed": seed,
            "duration_s": duration_s,
            "overrides": (*case.request.overrides, *case.changes),
            "schedules": case.request.schedules.model_copy(update={"pushes": pushes}),
        }
    )
    session = build(request)
    log = MotionLog(case.warm_s, end_s, session)
    walk_ = walk_session(session, log)
    walked = 1.0 if walk_.stopped_s is None else max(0.0, walk_.stopped_s) / duration_s
    terms = log.terms(rate_hz, facts)
    cost = objective.f_balance(walked, pushed=bool(pushes))
    if not pushes:
        cost += objective.f_recovery(log.recovery)
    found = {"walked": walked, "recovery": log.recovery}
    if terms is not None:
        factor = terms.pop("alteration")
        cost += factor * objective.f_sum(terms, case.start or terms, case.weights)
        found |= {"alteration": factor, **terms}
    speed = finite(mean_velocity(walk_.trace)[0]) if len(walk_.trace) > 1 else None
    wanted = walk_.report["target_speed_mps"]
    if speed is not None and wanted is not None and not pushes:
        error = speed - wanted
        found["speed_error"] = abs(error)
        cost += objective.f_speed(error, case.speed_tolerance * max(abs(wanted), 0.1))
    return found | {"cost": cost}


def growing_pushes(facts: RobotFacts, start_s: float, count: int) -> tuple[Push, ...]:
    """Pushes to all sides by turns, each a little harder than the one before."""
    force = facts.mass * facts.speed_scale / PUSH_S
    found = []
    for place in range(count):
        x, y = DIRECTIONS[AROUND[place % len(AROUND)]]
        size = force * (FIRST_FROUDE + FROUDE_STEP * place)
        found.append(
            Push(
                force=(size * x, size * y, 0.0),
                start=start_s + place * PUSH_EVERY * facts.time_scale,
                duration=PUSH_S,
            )
        )
    return tuple(found)


@lru_cache(maxsize=4)
def _facts(robot: str) -> RobotFacts:
    return robot_facts(load_robot(robot))
