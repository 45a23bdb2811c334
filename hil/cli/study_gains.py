"""`stride study gains`: the range of acceptable gains at falling control rates."""

from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request

WARM_S, LEG_S = 9.1, 7.8
"""Times of the walk in units of √(L/g): 2.8 s and 2.4 s of the seeds' character."""
STANDING_WARM_S = 50.0
"""The same of the time before a walk is judged, for a robot that starts standing."""


def gains(
    robot: options.Robot = "human",
    rates: Annotated[
        str, Option(help="Falling control rates in Hz, with commas between.")
    ] = "1000,750,500,300,275,250,225",
    pd: options.Pd = None,
    joint: Annotated[
        list[str] | None,
        Option(help="Vary the gains of this kind of joint only; repeatable.", show_default="all"),
    ] = None,
    iterations: Annotated[int, Option(help="Most iterations of a run of CMA.", min=1)] = 150,
    population: Annotated[
        int | None, Option(help="Candidates of an iteration.", show_default="4 + 3 ln n", min=4)
    ] = None,
    runs: Annotated[int, Option(help="Most runs for either end of a range.", min=1)] = 10,
    eta: Annotated[float, Option(help="Change of the gains below which runs end.")] = 0.05,
    sigma: Annotated[float, Option(help="First step, as a share of each gain.")] = 0.05,
    duration: Annotated[
        float | None, Option(help="Judged time of each walk in s.", show_default="7.2 √(L/.93)")
    ] = None,
    warm_up: Annotated[
        float | None, Option(help="Time before it is judged in s.", show_default="by the robot")
    ] = None,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    seed: Annotated[int, Option(help="Of the search.", min=0)] = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    scheduler: study_options.Scheduler = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Smallest and largest gains that still walk alike, at ever lower control rates."""
    from hil.studies.gain_range import GainRangeStudy, check_rates
    from hil.studies.search.budget import SearchBudget

    request = resolved_request(robot, speed, overrides, backend=backend, pd=pd)
    warm_s, leg_s = _times(robot, overrides, warm_up, duration)
    names = check_rates(rates)
    budget = SearchBudget(
        iterations=2 if quick else iterations, population=4 if quick else population
    )
    study = checked(
        GainRangeStudy,
        request=request,
        rates_hz=names[:2] if quick else names,
        joints=tuple(joint or ()),
        budget=budget,
        runs=1 if quick else runs,
        eta=eta,
        sigma=sigma,
        warm_s=warm_s,
        leg_s=leg_s,
        seed=seed,
    )
    study.start_gains()  # an unknown joint is told before there is a folder
    conduct(study, out, jobs, as_json=as_json, scheduler=scheduler)


def _times(
    robot: str, overrides: list[str] | None, warm_up: float | None, duration: float | None
) -> tuple[float, float]:
    """Time of the walk before it is judged, and of each judged leg [s]."""
    from hil.robot_facts import robot_facts
    from hil.robot_files import load_robot
    from hil.studies.gain_walks import SIGNS

    description = load_robot(robot, tuple(overrides or ()))
    unit_s = robot_facts(description).time_scale
    if warm_up is None:
        warm_up = (WARM_S if description.start.moving else STANDING_WARM_S) * unit_s
    leg_s = LEG_S * unit_s if duration is None else duration / len(SIGNS)
    return round(warm_up, 3), round(leg_s, 3)
