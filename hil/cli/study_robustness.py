"""`stride study robustness`: many robots, many conditions."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request


def robustness(
    robot: options.Robot = "minibiped",
    condition: Annotated[
        list[str] | None,
        Option("--condition", "-c", help="forward, turn, …; repeatable.", show_default="all"),
    ] = None,
    rate: Annotated[
        list[int] | None,
        Option("--rate", "-r", help="Control rate in Hz; repeatable.", show_default="300, 225"),
    ] = None,
    seeds: Annotated[int, Option(help="Robots: a seed draws what each hides.", min=1)] = 10,
    seed: Annotated[
        list[int] | None, Option(help="This robot; repeatable.", show_default="0 to --seeds")
    ] = None,
    phases: Annotated[int, Option(help="Phases of every push, over two steps.", min=1)] = 8,
    longest: Annotated[
        float | None, Option(help="No walk takes longer than this, in s.", show_default="none")
    ] = None,
    blame: Annotated[
        bool, Option("--blame/--no-blame", help="Which draw fells the robots that fall?")
    ] = True,
    ends: Annotated[
        bool, Option("--ends/--no-ends", help="Every draw alone, at the ends of its range.")
    ] = True,
    backend: study_options.Backend = None,
    estimator: options.Estimator = None,
    ankle_limit: options.AnkleLimit = None,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Which robots of a servo biped walk in which conditions, and what fells the others."""
    from hil.studies.conditions import CONDITIONS
    from hil.studies.robustness import RobustnessStudy, check_conditions, require_servos

    request = resolved_request(
        robot, None, overrides, backend=backend, estimator=estimator, ankle_limit=ankle_limit,
    )  # fmt: skip
    require_servos(request)
    names = check_conditions(condition or list(CONDITIONS))
    chosen = tuple(seed or range(seeds))
    study = checked(
        RobustnessStudy,
        request=request,
        conditions=names[:2] if quick and not condition else names,
        rates_hz=tuple(rate or (300, 225))[: 1 if quick else None],
        seeds=chosen[: 1 if quick else None],
        phases=1 if quick else phases,
        longest_s=3.0 if quick else longest,
        blame=blame and not quick,
        ends=ends and not quick,
    )
    conduct(study, out, jobs, as_json=as_json)
