"""The walks of `stride study stabilizer`: one with each variant, the model comparison, pushes."""

from typing import Any, Literal, get_args

from pydantic import NonNegativeFloat, PositiveFloat, PositiveInt

from hil.compose import model_comparison
from hil.cycle import TickRecord
from hil.gait_report import LOADED_STANCE
from hil.interface import Floats
from hil.request import RunRequest, StabilizerSolverName
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.schedule import Push
from hil.studies.coronal_cycle import coronal_cycle
from hil.studies.physics_step import PhysicsStep
from hil.studies.study import Case, Result
from hil.studies.walks import Walk, mean_step_time, walk
from hil.validation import Config

MODEL_KEY = "walking.stabilizer.model"
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
    cell_noise_n: NonNegativeFloat = 0.0
    """White noise on every corner force of the estimate [N]."""


class PushedCase(Case):
    """A straight walk at one control rate, pushed from both sides in turn."""

    variant: Variant
    rate_hz: PositiveInt
    duration_s: PositiveFloat
    force_n: PositiveFloat


PUSH_S = 0.3
PUSH_EVERY_S = 4.0
"""The seed pushes for 0.3 s; between two pushes there is time to recover."""


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
    physics = PhysicsStep(load_robot(request.robot, request.overrides), request.rate_hz or 300)
    walked = walk(request, physics, cell_noise_n=case.cell_noise_n)
    return {**_figures(walked), "mj_step_ms": physics.mean_ms}


def walk_pushed(case: PushedCase) -> Result:
    """Figures of a walk with lateral pushes."""
    request = variant_request(case.request, case.variant)
    pushes = lateral_pushes(case.force_n, case.duration_s)
    schedules = request.schedules.model_copy(update={"pushes": pushes})
    changes = {"schedules": schedules, "duration_s": case.duration_s, "rate_hz": case.rate_hz}
    return _figures(walk(request.model_copy(update=changes)))


def lateral_pushes(force_n: float, duration_s: float) -> tuple[Push, ...]:
    """Pushes of 0.3 s to the left and to the right in turn, one every four seconds."""
    count = int((duration_s - PUSH_S) / PUSH_EVERY_S)
    return tuple(
        Push(
            force=(0.0, force_n * (-1) ** number, 0.0),
            start=(number + 1) * PUSH_EVERY_S,
            duration=PUSH_S,
        )
        for number in range(count)
    )


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
