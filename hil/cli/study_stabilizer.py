"""`stride study stabilizer`: solvers, reduced models and ankle rules of the stabilizer."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request


def stabilizer(
    robot: options.Robot = "human",
    steps: Annotated[int, Option(help="Steps of each walk.", min=10)] = 200,
    solver: Annotated[
        list[str] | None, Option(help="cma, linear, scan; repeatable.", show_default="all")
    ] = None,
    model_solver: Annotated[str, Option(help="Solver that compares the models.")] = "cma",
    models: Annotated[bool, Option("--models/--no-models", help="M1-M6 as well.")] = True,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    rate: options.Rate = None,
    pd: options.Pd = None,
    estimator: options.Estimator = None,
    ankle: Annotated[
        list[str] | None,
        Option(help="Ankle rule: none, guards, limit; repeatable.", show_default="guards, limit"),
    ] = None,
    cell_noise: Annotated[
        float, Option(help="White noise on every corner force of the estimate in N.", min=0.0)
    ] = 0.0,
    push_rate: Annotated[
        list[int] | None,
        Option(help="Also walk at this rate, pushed sideways; repeatable.", min=20),
    ] = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = 1,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Ground contact stabilizer: solvers, reduced models, ankle rules; errors and time."""
    from hil.studies.stabilizer import MODELS, SOLVERS, StabilizerStudy

    request = resolved_request(
        robot, speed, overrides, backend=backend, rate_hz=rate, pd=pd, estimator=estimator,
        seed=seed, stabilizer=True,
    )  # fmt: skip
    ankles = tuple(ankle or ("guards", "limit"))
    study = checked(
        StabilizerStudy,
        request=request,
        steps=10 if quick else steps,
        solvers=tuple(solver or SOLVERS)[: 1 if quick else None],
        models=MODELS if models and not quick else (),
        model_solver=model_solver,
        ankles=ankles[-1:] if quick else ankles,
        probe_s=3.0 if quick else 10.0,
        cell_noise_n=cell_noise,
        push_rates=tuple(push_rate or ()),
    )
    conduct(study, out, jobs, as_json=as_json)
