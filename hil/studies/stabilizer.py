"""`stride study stabilizer`: solvers and reduced models of the ground contact stabilizer.

Figure 1 of seed 000_bd1305a0ae731442: error of the models M1-M6 against the whole robot M0,
disequilibrium and time with each of them, and the walk without stabilizer.
"""

from functools import partial
from typing import Any, ClassVar, Literal, get_args

from pydantic import Field, PositiveFloat, PositiveInt

from hil.compose import model_comparison
from hil.cycle import TickRecord
from hil.errors import StrideError
from hil.gait_report import LOADED_STANCE
from hil.interface import Floats
from hil.request import RunRequest, StabilizerSolverName
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies.coronal_cycle import FROUDE_SPEED, coronal_cycle
from hil.studies.figures_stabilizer import draw_stabilizer
from hil.studies.study import Case, Result, RunCases, Study, StudyResult, Table
from hil.studies.titles import outcome, title
from hil.studies.walks import Walk, mean_step_time, walk
from hil.validation import Config

MODEL_KEY = "walking.stabilizer.model"
SOLVERS: tuple[StabilizerSolverName, ...] = get_args(StabilizerSolverName)
MODELS = ("M1", "M2", "M3", "M4", "M5", "M6")


AnkleRule = Literal["none", "guards", "limit"]
ANKLE_RULES: tuple[AnkleRule, ...] = get_args(AnkleRule)
"""What bounds the stance ankle's torque: nothing, the stored code's rules, or the load."""
GUARDS_KEY = "walking.ankle_guards"


class Variant(Config):
    """A way to keep the stance foot in contact."""

    solver: StabilizerSolverName | None = None
    """None: no stabilizer."""
    model: str = "M0"
    ankle: AnkleRule

    @property
    def name(self) -> str:
        """In tables: `base`, or solver and model."""
        return "base" if self.solver is None else f"{self.solver} {self.model}"


class StepTimeCase(Case):
    """A straight walk with ankle limit and without stabilizer, whose steps are timed."""

    duration_s: PositiveFloat


class StabilizerCase(Case):
    """The coronal cycle, walked with one variant."""

    variant: Variant
    steps: PositiveInt
    step_s: PositiveFloat
    """Mean time of a step [s]."""
    amplitude: PositiveFloat
    """Coronal speed [m/s]."""
    compare_models: bool = False
    """Instead of the variant's figures, errors of the models in every tick."""


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

    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Walk with every variant, and compare the models once."""
        facts = robot_facts(load_robot(self.request.robot, self.request.overrides))
        make = partial(
            StabilizerCase,
            request=self.request,
            steps=self.steps,
            step_s=self._step_time(run_cases),
            amplitude=FROUDE_SPEED * facts.speed_scale,
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
        return StudyResult(rows, [self._table(head, rows)], draw, notes)

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
            "", "", "steps", "disequil. %", "controller ms", "stabilizer ms",
            "iterations", "limit hit %", "model error %", "sample µs", "speed error %", "",
        )  # fmt: skip
        keys = (
            "disequilibrium_pct", "controller_ms", "stabilizer_ms", "iterations", "limit_pct",
            "model_error_pct", "sample_us", "speed_error_pct",
        )  # fmt: skip
        lines = [
            (
                row["variant"],
                row["ankle"],
                str(row["steps"]),
                *("–" if row[key] is None else f"{row[key]:.2f}" for key in keys),
                outcome(row),
            )
            for row in rows
        ]
        return Table(f"{head}: {self.steps} steps of the coronal cycle", heads, lines)


EMPTY: Result = dict.fromkeys(
    (
        "variant", "solver", "model", "ankle", "steps", "disequilibrium_pct",
        "controller_ms", "stabilizer_ms", "iterations", "limit_pct", "model_error_pct",
        "sample_us", "speed_error_pct", "ending", "stopped_s", "error",
    )
)  # fmt: skip
"""Columns of the CSV."""


class ModelErrors:
    """A sink that lets every reduced model predict the forces on a loaded stance foot."""

    def __init__(self, request: RunRequest, weight_n: float) -> None:
        self._comparison = model_comparison(request)
        self._least = LOADED_STANCE * weight_n

    def put(self, record: TickRecord) -> None:
        """Compare the models in one tick."""
        status, estimate = record.status, record.estimate
        loads: Floats = estimate.foot_force.sum(axis=1) + estimate.toe_force
        stance = status.stance
        if record.time_s >= 0 and status.walking and loads[stance] > self._least:
            swing = bool(loads[1 - stance] > 0.0)
            self._comparison.add(estimate, record.command.torque, stance, swing)

    def results(self) -> Result:
        """Error [% of M0's forces] and time of a sample [µs] of each model."""
        found = self._comparison
        errors = 100.0 * found.errors / max(found.load, 1e-9)
        times = found.sample_ns / max(found.ticks, 1) * 1e-3
        return {
            name: {"model_error_pct": float(error), "sample_us": float(time)}
            for name, error, time in zip(found.names, errors, times, strict=True)
        }


def time_steps(case: StepTimeCase) -> Result:
    """Mean time of a step [s]."""
    request = variant_request(case.request, Variant(ankle="limit"))
    walked = walk(request.model_copy(update={"duration_s": case.duration_s}))
    return {"step_s": mean_step_time(walked.trace)}


def walk_variant(case: StabilizerCase) -> Result:
    """Figures of the coronal cycle with one variant, or the errors of all models in it."""
    request = variant_request(case.request, case.variant)
    duration_s = case.steps * case.step_s
    points = coronal_cycle(case.amplitude, case.step_s, duration_s)
    schedules = request.schedules.model_copy(update={"lateral": points})
    request = request.model_copy(update={"schedules": schedules, "duration_s": duration_s})
    if case.compare_models:
        facts = robot_facts(load_robot(request.robot, request.overrides))
        errors = ModelErrors(request, facts.weight)
        walk(request, errors)
        return {"models": errors.results()}
    return _figures(walk(request))


def variant_request(request: RunRequest, variant: Variant) -> RunRequest:
    """The request with a variant's stabilizer and ankle rule."""
    changes: dict[str, Any] = {
        "stabilizer": variant.solver is not None,
        "stabilizer_solver": variant.solver,
        "ankle_limit": variant.ankle == "limit",
    }
    overrides = request.overrides
    if variant.ankle == "guards":
        overrides += (f"{GUARDS_KEY}=true",)
    if variant.solver is not None:
        overrides += (f"{MODEL_KEY}={variant.model}",)
    return request.model_copy(update={**changes, "overrides": overrides})


def _figures(walked: Walk) -> Result:
    report = walked.report
    return {
        "steps": report["steps"],
        "disequilibrium_pct": report["disequilibrium_pct"],
        "controller_ms": report["controller_ms_mean"],
        "iterations": report["stabilizer_iterations_mean"],
        "limit_pct": report["stabilizer_limit_pct"],
        "speed_error_pct": report["speed_error_pct"],
        "ending": walked.ending,
        "stopped_s": walked.stopped_s,
    }


def _add_stabilizer_time(rows: list[Result]) -> None:
    """The controller's time beyond that of the base walk with the same ankle rule [ms]."""
    base = {row["ankle"]: row["controller_ms"] for row in rows if row["solver"] is None}
    for row in rows:
        own, without = row["controller_ms"], base.get(row["ankle"])
        if row["solver"] is not None and own is not None and without is not None:
            row["stabilizer_ms"] = own - without
