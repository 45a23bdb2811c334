"""`stride study gait`: the offline optimisation of a walk."""

from typing import Annotated, Any

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request
from hil.request import RunRequest

Space = Annotated[
    str | None,
    Option(
        help="poses (key poses of a torque robot), style (those for one speed and level of "
        "water), gait (numbers under walking), gains (of servo joints, inside what registers do).",
        show_default="poses; gait for servo robots",
    ),
]
Vary = Annotated[
    list[str] | None,
    Option(help="A number under walking, or a gain such as knee.kp; repeatable."),
]
Rates = Annotated[
    list[int] | None,
    Option("--rate", "-r", help="Control rate in Hz; repeatable.", show_default="robot's"),
]
Seeds = Annotated[
    int | None,
    Option(
        help="Robots that judge a candidate: 0, 1, ….", min=1,
        show_default="3; 1 for torque robots, which hide nothing",
    ),
]  # fmt: skip
Weights = Annotated[
    list[str] | None,
    Option(
        "--weight", help="NAME=W of energy, drag, acceleration; repeatable.",
        show_default="the weighting's",
    ),
]  # fmt: skip
Weighting = Annotated[
    str,
    Option(help="3-6-1, 2-8-1, 4-5-1 (energy, drag, acceleration), or one of their names alone."),
]
Level = Annotated[float | None, Option("--level", "-l", help="Level of water in m.", min=0)]
Pushes = Annotated[
    int, Option(help="Growing pushes after the judged time; what they fell counts.", min=0)
]
Tolerance = Annotated[
    float | None,
    Option(help="Share of the speed that may be missed.", show_default="0.01; servos 0.05"),
]


Population = Annotated[
    int | None, Option(help="Candidates of an iteration.", show_default="4 + 3 ln n", min=4)
]
Sigma = Annotated[float, Option(help="First standard deviation, in spreads of the variables.")]


def _in_water(request: RunRequest, level: float) -> RunRequest:
    """The request in water of a level [m]; on dry land with none."""
    if level == 0.0:
        return request
    wet = request.schedules.model_copy(update={"water": ((0.0, level),)})
    return request.model_copy(update={"schedules": wet})


def _cell(speed: float, level: float, quick: bool) -> dict[str, Any]:
    """Settings of a search for the style of one speed [m/s] and level [m]."""
    shorter = {"present_s": 4.5, "held_s": 3.0} if quick else {}
    return {"speed": speed, "level": level, **shorter}


def gait(
    robot: options.Robot = "minibiped",
    space: Space = None,
    vary: Vary = None,
    rate: Rates = None,
    seeds: Seeds = None,
    weighting: Weighting = "3-6-1",
    weight: Weights = None,
    level: Level = None,
    pushes: Pushes = 0,
    speed_tolerance: Tolerance = None,
    iterations: Annotated[int, Option(help="Most iterations of CMA-ES.", min=1)] = 60,
    population: Population = None,
    sigma: Sigma = 1.0,
    warm: Annotated[float, Option(help="Walking time before the walk is judged in s.")] = 5.0,
    judged: Annotated[float, Option(help="Time that is judged in s.")] = 5.0,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    pd: options.Pd = None,
    estimator: options.Estimator = None,
    seed: Annotated[int, Option(help="Of the search.", min=0)] = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    scheduler: study_options.Scheduler = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Search for a better walk: key poses, numbers of the gait, or servo gains, by CMA-ES."""
    from hil.robot_files import load_robot
    from hil.studies.gait_search import GaitStudy, check_weights
    from hil.studies.search.budget import SearchBudget
    from hil.studies.style_search import StyleStudy

    request = resolved_request(
        robot, speed, overrides, backend=backend, rate_hz=rate[0] if rate else None, pd=pd,
        estimator=estimator,
    )  # fmt: skip
    description = load_robot(robot, request.overrides)
    servo = description.actuation == "servo"
    iterations, population = (1, 4) if quick else (iterations, population)
    styled, walked = space == "style", description.defaults.speed if speed is None else speed
    searched = {"space": space or ("gait" if servo else "poses")}
    study = checked(
        StyleStudy if styled else GaitStudy,
        request=_in_water(request, level or 0.0),
        **(_cell(walked, level or 0.0, quick) if styled else searched),
        vary=tuple(vary or ()),
        rates_hz=tuple(rate or (request.rate_hz,)),
        seeds=tuple(range(1 if quick else seeds or (3 if servo else 1))),
        sigma=sigma,
        weights=check_weights(weighting, weight),
        budget=SearchBudget(iterations=iterations, population=population),
        warm_s=1.0 if quick else warm,
        judged_s=1.0 if quick else judged,
        pushes=pushes,
        speed_tolerance=speed_tolerance or (0.05 if servo else 0.01),
        search_seed=seed,
    )
    conduct(study, out, jobs, as_json=as_json, scheduler=scheduler)
