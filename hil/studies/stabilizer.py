"""`stride study stabilizer`: solvers and reduced models of the ground contact stabilizer.

Figure 1 of seed 000_bd1305a0ae731442: error of the models M1-M6 against the whole robot M0,
disequilibrium and time with each of them, and the walk without stabilizer.
"""

from functools import partial
from typing import ClassVar, get_args

from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt

from hil.errors import StrideError
from hil.request import StabilizerSolverName
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies.coronal_cycle import FROUDE_SPEED
from hil.studies.figures_stabilizer import draw_stabilizer
from hil.studies.stabilizer_walks import (
    PUSH_S,
    AnkleRule,
    PushedCase,
    StabilizerCase,
    StepTimeCase,
    Variant,
    time_steps,
    walk_pushed,
    walk_variant,
)
from hil.studies.study import Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import number, outcome, title

SOLVERS: tuple[StabilizerSolverName, ...] = get_args(StabilizerSolverName)
MODELS = ("M1", "M2", "M3", "M4", "M5", "M6")


class StabilizerStudy(Study):
    """Walks with the coronal speed cycling 0, +v, −v every five steps, v/√(gL) = 0.066.

    Every solver with M0, then every model with one solver, each with every ankle
    rule; `base` has no stabilizer. Times are wall times of this machine: compare them
    within one study, and run it with one job.
    """

    name: ClassVar[str] = "stabilizer"
    steps: PositiveInt
    """Length of each walk, by the base walk's step time."""
    solvers: tuple[StabilizerSolverName, ...] = Field(min_length=1)
    models: tuple[str, ...]
    model_solver: StabilizerSolverName
    """Solver with which the models are compared."""
    ankles: tuple[AnkleRule, ...] = Field(min_length=1)
    probe_s: PositiveFloat
    """Length of the walk whose steps are timed [s]."""
    cell_noise_n: NonNegativeFloat = 0.0
    """White noise on every corner force of the estimate [N]."""
    push_rates: tuple[PositiveInt, ...] = ()
    """Control rates at which walks are pushed sideways."""

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk with every variant, and compare the models once."""
        facts = robot_facts(load_robot(self.request.robot, self.request.overrides))
        make = partial(
            StabilizerCase,
            request=self.request,
            steps=self.steps,
            step_s=(step_s := self._step_time(run_cases)),
            amplitude=FROUDE_SPEED * facts.speed_scale,
            cell_noise_n=self.cell_noise_n,
        )
        variants = self._variants()
        compared = make(variant=Variant(ankle="limit"), compare_models=True)
        cases = [compared, *(make(variant=variant) for variant in variants)]
        first, *results = run_cases(walk_variant, cases)
        errors: Result = first.get("models", {})
        rows = [
            EMPTY
            | {
                "variant": variant.name,
                "solver": variant.solver,
                "model": None if variant.solver is None else variant.model,
                "ankle": variant.ankle,
                **(errors.get(variant.model, {}) if variant.solver else {}),
            }
            | result
            for variant, result in zip(variants, results, strict=True)
        ]
        _add_stabilizer_time(rows)
        head = title(self.request)
        notes = [f"models not compared: {first['error']}"] if "error" in first else []
        draw = partial(draw_stabilizer, head, rows)
        force_n = PUSH_FROUDE * facts.mass * facts.speed_scale / PUSH_S
        pushed = self._pushed(run_cases, self.steps * step_s, force_n)
        tables = [self._table(head, rows)]
        if pushed:
            tables.append(push_table(head, pushed, force_n))
        return StudyResult([*rows, *pushed], tables, draw, notes)

    def _pushed(self, run_cases: RunCases, duration_s: float, force_n: float) -> list[Result]:
        """Rows of the walks that are pushed sideways."""
        kinds = [
            (Variant(solver=solver, ankle=ankle), rate)
            for ankle in self.ankles
            for solver in self.solvers
            for rate in self.push_rates
        ]
        cases = [
            PushedCase(
                request=self.request,
                variant=variant,
                rate_hz=rate,
                duration_s=duration_s,
                force_n=force_n,
            )
            for variant, rate in kinds
        ]
        results = run_cases(walk_pushed, cases)
        return [
            EMPTY
            | {
                "variant": variant.name,
                "solver": variant.solver,
                "model": variant.model,
                "ankle": variant.ankle,
                "pushed_rate_hz": rate,
            }
            | result
            for (variant, rate), result in zip(kinds, results, strict=True)
        ]

    def _step_time(self, run_cases: RunCases) -> float:
        probe = StepTimeCase(request=self.request, duration_s=self.probe_s)
        result = run_cases(time_steps, [probe])[0]
        if "error" in result:
            raise StrideError(f"the walk that times the steps: {result['error']}")
        return float(result["step_s"])

    def _variants(self) -> list[Variant]:
        kinds: list[tuple[StabilizerSolverName | None, str]] = [(None, "M0")]
        kinds += [(solver, "M0") for solver in self.solvers]
        kinds += [(self.model_solver, model) for model in self.models]
        return [
            Variant(solver=solver, model=model, ankle=ankle)
            for ankle in self.ankles
            for solver, model in kinds
        ]

    def _table(self, head: str, rows: list[Result]) -> Table:
        heads = (
            "", "", "steps", "disequil. %", "controller ms", "× mj_step", "stabilizer ms",
            "× mj_step", "iterations", "limit hit %", "model error %", "sample µs",
            "speed error %", "",
        )  # fmt: skip
        keys = (
            "disequilibrium_pct", "controller_ms", "controller_steps", "stabilizer_ms",
            "stabilizer_steps", "iterations", "limit_pct", "model_error_pct", "sample_us",
            "speed_error_pct",
        )  # fmt: skip
        lines = [
            (
                row["variant"],
                row["ankle"],
                str(row["steps"]),
                *(number(row[key], ".2f") for key in keys),
                outcome(row),
            )
            for row in rows
        ]
        return Table(f"{head}: {self.steps} steps of the coronal cycle", heads, lines)


EMPTY: Result = dict.fromkeys(
    (
        "variant", "solver", "model", "ankle", "steps", "disequilibrium_pct",
        "controller_ms", "mj_step_ms", "controller_steps", "stabilizer_ms", "stabilizer_steps",
        "iterations", "limit_pct", "model_error_pct",
        "sample_us", "speed_error_pct", "ending", "stopped_s", "error", "pushed_rate_hz",
    )
)  # fmt: skip
"""Columns of the CSV."""


PUSH_FROUDE = 0.141
"""Δv/√(gL) of 100 N × 0.3 s on the seed's character."""


def push_table(head: str, rows: list[Result], force_n: float) -> Table:
    """How often the search ends at its limit under lateral pushes, by control rate."""
    heads = ("", "", "rate Hz", "limit hit %", "iterations", "disequil. %", "")
    lines = [
        (
            row["variant"],
            row["ankle"],
            str(row["pushed_rate_hz"]),
            *(number(row[key], ".2f") for key in ("limit_pct", "iterations", "disequilibrium_pct")),
            outcome(row),
        )
        for row in rows
    ]
    return Table(f"{head}: {force_n:.0f} N to the side for {PUSH_S:g} s", heads, lines)


def _add_stabilizer_time(rows: list[Result]) -> None:
    """The controller's time beyond that of the base walk with the same ankle rule [ms].

    Both also as multiples of one `mj_step` in the same walk, which a busy machine leaves as
    they are: the base's multiple is subtracted, not its milliseconds.
    """
    for row in rows:
        if row["controller_ms"] is not None and row["mj_step_ms"]:
            row["controller_steps"] = row["controller_ms"] / row["mj_step_ms"]
    bases = {row["ankle"]: row for row in rows if row["solver"] is None}
    for row in rows:
        base = bases.get(row["ankle"])
        if row["solver"] is None or base is None:
            continue
        for own, total in (
            ("stabilizer_ms", "controller_ms"),
            ("stabilizer_steps", "controller_steps"),
        ):
            if row[total] is not None and base[total] is not None:
                row[own] = row[total] - base[total]
