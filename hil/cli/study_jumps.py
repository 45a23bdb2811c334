"""`stride study jumps`: a grid of jumps."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request

FORWARD, LATERAL, HEIGHTS, AIRTIMES = (
    (0.0, 0.3, 0.6),
    (-0.2, 0.0, 0.2),
    (-0.15, 0.0, 0.15),
    (0.35, 0.45),
)


def jumps(
    robot: options.Robot = "human",
    forward: Annotated[
        list[float] | None,
        Option("--forward", "-x", help="In m; repeatable.", show_default="0, 0.3, 0.6"),
    ] = None,
    lateral: Annotated[
        list[float] | None,
        Option("--lateral", "-y", help="In m, left positive; repeatable.", show_default="±0.2, 0"),
    ] = None,
    height: Annotated[
        list[float] | None,
        Option("--height", "-z", help="Of the landing in m; repeatable.", show_default="±0.15, 0"),
    ] = None,
    airtime: Annotated[
        list[float] | None,
        Option("--airtime", "-t", help="In s; repeatable.", show_default="0.35, 0.45"),
    ] = None,
    push_depth: Annotated[float | None, Option(help="In m.", show_default="0.32 leg")] = None,
    backend: study_options.Backend = None,
    rate: options.Rate = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Where jumps land, and whether standing: targets x airtimes, the infeasible ones refused."""
    from hil.compose import default_push_depth
    from hil.studies.jumps import JumpStudy

    request = resolved_request(robot, 0.0, overrides, backend=backend, rate_hz=rate, seed=seed)
    if push_depth is None:
        push_depth = default_push_depth(robot, tuple(overrides or ()))
    study = checked(
        JumpStudy,
        request=request,
        forward=tuple(forward or FORWARD)[: 1 if quick else None],
        lateral=tuple(lateral or LATERAL)[: 1 if quick else None],
        heights=tuple(height or HEIGHTS)[: 1 if quick else None],
        airtimes=tuple(airtime or AIRTIMES)[: 1 if quick else None],
        push_depth=push_depth,
    )
    conduct(study, out, jobs, as_json=as_json)
