"""`stride study water`: speeds reached in a liquid, over its level, density and viscosity."""

from functools import partial
from typing import ClassVar

from pydantic import Field, NonNegativeFloat, PositiveFloat

from hil.request import RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies.figures_water import draw_water
from hil.studies.foot_lift import foot_lift
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, outcome, title
from hil.studies.walks import finite, mean_velocity, walk

LEVELS = (0.0, 0.2688, 0.5376, 0.8065, 1.0753)
"""0 … 1 m on the 0.93 m leg of the seed's character, as parts of the leg."""
SPEED_FROUDE = (0.0660, 0.099, 0.1320, 0.1650, 0.1980, 0.2310)
"""0.2 … 0.7 m/s of the same as v/√(gL)."""


class WaterCase(Case):
    """A walk at constant speed in a liquid that stays as it is."""

    speed: float
    """Sagittal [m/s]."""
    level: NonNegativeFloat
    """[m]"""
    density: PositiveFloat
    """[kg/m³]"""
    viscosity: PositiveFloat
    """Factor on the drag."""
    lateral: float = 0.0
    """Coronal, left positive [m/s]."""


class WaterStudy(Study):
    """Walks in liquids. Reached speeds are means over whole strides, from 5 s on."""

    name: ClassVar[str] = "water"
    speeds: tuple[float, ...] = Field(min_length=1)
    laterals: tuple[float, ...] = Field(min_length=1)
    levels: tuple[NonNegativeFloat, ...] = Field(min_length=1)
    densities: tuple[PositiveFloat, ...] = Field(min_length=1)
    viscosities: tuple[PositiveFloat, ...] = Field(min_length=1)
    duration_s: PositiveFloat

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk every combination."""
        request = self.request.model_copy(update={"duration_s": self.duration_s})
        cases = [
            WaterCase(
                request=request,
                speed=speed,
                lateral=lateral,
                level=level,
                density=density,
                viscosity=viscosity,
            )
            for density in self.densities
            for viscosity in self.viscosities
            for level in self.levels
            for lateral in self.laterals
            for speed in self.speeds
        ]
        rows = [
            EMPTY
            | {
                "target_mps": case.speed,
                "lateral_target_mps": case.lateral,
                "level_m": case.level,
                "density_kgpm3": case.density,
                "viscosity": case.viscosity,
            }
            | result
            for case, result in zip(cases, run_cases(reach_speed, cases), strict=True)
        ]
        draw = partial(draw_water, title(self.request), rows)
        return StudyResult(rows, [self._table(rows)], draw)

    def _table(self, rows: list[Result]) -> Table:
        heads = (
            "level", "density", "viscosity", "speed", "reached", "error %", "sideways", "reached",
            "lift m", "",
        )  # fmt: skip
        lines = [
            (
                f"{row['level_m']:.2f}",
                f"{row['density_kgpm3']:g}",
                f"{row['viscosity']:g}",
                f"{row['target_mps']:.2f}",
                number(row["speed_mps"], ".3f"),
                number(row["error_pct"], ".1f"),
                f"{row['lateral_target_mps']:.2f}",
                number(row["lateral_mps"], ".3f"),
                number(row["lift_m"], ".2f"),
                outcome(row),
            )
            for row in rows
        ]
        return Table(f"{title(self.request)}: {self.duration_s:g} s each", heads, lines)


EMPTY: Result = dict.fromkeys(
    (
        "target_mps",
        "lateral_target_mps",
        "level_m",
        "density_kgpm3",
        "viscosity",
        "speed_mps",
        "error_pct",
        "lateral_mps",
        "lift_m",
        "steps",
        "real_time_factor",
        "ending",
        "stopped_s",
        "error",
    )
)
"""Columns of the CSV."""


def reach_speed(case: WaterCase) -> Result:
    """Reached speed, lift of the feet, and whether the walk came to its end."""
    asked = {"speed": case.speed, "lateral": case.lateral}
    if case.level > 0.0:
        asked |= {"water": case.level, "density": case.density, "viscosity": case.viscosity}
    schedules = case.request.schedules.model_copy(
        update={name: ((0.0, value),) for name, value in asked.items()}
    )
    walked = walk(case.request.model_copy(update={"schedules": schedules}))
    ended = walked.stopped_s is None
    reached = mean_velocity(walked.trace) if ended else (float("nan"), float("nan"))
    speed, lateral = finite(reached[0]), finite(reached[1])
    error = None
    if speed is not None and case.speed != 0.0:
        error = 100.0 * (speed - case.speed) / abs(case.speed)
    description = load_robot(case.request.robot, case.request.overrides)
    return {
        "speed_mps": speed,
        "error_pct": error,
        "lateral_mps": lateral,
        "lift_m": foot_lift(description, walked.trace) if ended else None,
        "steps": walked.report["steps"],
        "real_time_factor": walked.report["real_time_factor"],
        "ending": walked.ending,
        "stopped_s": walked.stopped_s,
    }


def default_grid(request: RunRequest) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Levels [m] and speeds [m/s] of the human's grid, scaled to a robot by L and √(gL)."""
    facts = robot_facts(load_robot(request.robot, request.overrides))
    levels = tuple(round(part * facts.leg_length, 2) for part in LEVELS)
    speeds = tuple(round(froude * facts.speed_scale, 2) for froude in SPEED_FROUDE)
    return levels, speeds
