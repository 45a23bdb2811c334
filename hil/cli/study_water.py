"""`stride study water`: walks in a liquid."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request
from hil.schedule import parse_ball


def water(
    robot: options.Robot = "human",
    speed: Annotated[
        list[float] | None,
        Option("--speed", "-s", help="Speed in m/s; repeatable.", show_default="scaled"),
    ] = None,
    lateral: Annotated[
        list[float] | None,
        Option(help="Sideways speed in m/s, left positive; repeatable.", show_default="0"),
    ] = None,
    level: Annotated[
        list[float] | None,
        Option("--level", "-l", help="Level in m above the floor; repeatable."),
    ] = None,
    density: Annotated[
        list[float] | None,
        Option(help="Density in kg/m³; repeatable.", show_default="1000"),
    ] = None,
    viscosity: Annotated[
        list[float] | None,
        Option(help="Factor on the drag; repeatable.", show_default="1"),
    ] = None,
    ball: options.Ball = None,
    duration: Annotated[float, Option(help="Walking time of each walk in s.")] = 20.0,
    backend: study_options.Backend = None,
    rate: options.Rate = None,
    pd: options.Pd = None,
    estimator: options.Estimator = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Speed reached and feet lifted over a grid of speeds and water levels.

    With --ball every walk is hit; its speeds are means that include what the hit cost.
    """
    from hil.studies.water import WaterStudy, default_grid

    request = resolved_request(
        robot, None, overrides, backend=backend, rate_hz=rate, pd=pd, estimator=estimator,
        seed=seed,
    )  # fmt: skip
    balls = tuple(parse_ball("--ball", text) for text in ball or ())
    schedules = request.schedules.model_copy(update={"balls": balls})
    request = request.model_copy(update={"schedules": schedules})
    levels, speeds = default_grid(request)
    study = checked(
        WaterStudy,
        request=request,
        levels=tuple(level or levels)[: 2 if quick else None],
        speeds=tuple(speed or speeds)[: 1 if quick else None],
        laterals=tuple(lateral or (0.0,)),
        densities=tuple(density or (1000.0,)),
        viscosities=tuple(viscosity or (1.0,)),
        duration_s=3.0 if quick else duration,
    )
    conduct(study, out, jobs, as_json=as_json)
