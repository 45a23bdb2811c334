"""`stride study ...`: many walks, one table."""

from typing import Annotated

from typer import Option, Typer

from hil.cli import options, study_options
from hil.cli.study_ceiling import ceiling
from hil.cli.study_conduct import checked, conduct, resolved_request
from hil.cli.study_gains import gains
from hil.cli.study_gait import gait
from hil.cli.study_jumps import jumps
from hil.cli.study_robustness import robustness
from hil.cli.study_stabilizer import stabilizer
from hil.cli.study_water import water
from hil.cli.study_windup import windup

EPILOG = """[bold]Examples[/bold]

stride study pushes human --pd implicit --direction left --force-step 50 --force-max 300

stride study speeds minibiped --backend mujoco --sagittal 0 --sagittal 0.2

stride study rates human --jobs 2

stride study robustness minibiped --condition forward --seeds 3

An interrupted study goes on where it stopped: give the same command again.
"""

app = Typer(
    name="study",
    no_args_is_help=True,
    rich_markup_mode="rich",
    epilog=EPILOG,
    help="Many walks in parallel, one table: CSV, figure, and every case that is done is kept.",
)
app.command()(robustness)
app.command()(gains)
app.command()(ceiling)
app.command()(gait)
app.command()(jumps)
app.command()(water)
app.command()(stabilizer)
app.command()(windup)


@app.command()
def pushes(
    robot: options.Robot = "minibiped",
    direction: Annotated[
        list[str] | None,
        Option(
            "--direction",
            "-d",
            help="forward, back_left, …; repeatable.",
            show_default="the four main ones",
        ),
    ] = None,
    diagonals: Annotated[bool, Option("--diagonals", help="All eight directions.")] = False,
    phases: Annotated[int, Option(help="Phases over two steps.", min=1)] = 8,
    force_step: Annotated[
        float | None, Option(help="Step of the ladder in N.", show_default="0.07 √(gL)·m/Δt")
    ] = None,
    force_max: Annotated[
        float | None, Option(help="End of the ladder in N.", show_default="0.42 √(gL)·m/Δt")
    ] = None,
    duration: Annotated[float, Option(help="Duration Δt of the push in s.")] = 0.3,
    settle: Annotated[float, Option(help="Walking time before the push in s.")] = 5.0,
    duration_after: Annotated[float, Option(help="Walking time after the push in s.")] = 6.0,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    rate: options.Rate = None,
    pd: options.Pd = None,
    estimator: options.Estimator = None,
    stabilizer: study_options.Stabilizer = None,
    ankle_limit: options.AnkleLimit = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """The largest push that is survived, by direction and phase, also as Δv/√(gL)."""
    from hil.studies.pushes import CARDINAL, DIRECTIONS, PushStudy, check_directions, ladder

    request = resolved_request(
        robot, speed, overrides, backend=backend, rate_hz=rate, pd=pd, estimator=estimator,
        stabilizer=stabilizer, ankle_limit=ankle_limit, seed=seed,
    )  # fmt: skip
    names = tuple(DIRECTIONS) if diagonals else check_directions(direction or list(CARDINAL))
    forces = ladder(request, force_step, force_max, duration)
    study = checked(
        PushStudy,
        request=request,
        directions=names[:1] if quick else names,
        phases=2 if quick else phases,
        forces=forces[:1] if quick else forces,
        push_s=duration,
        settle_s=1.5 if quick else settle,
        follow_s=1.0 if quick else duration_after,
    )
    conduct(study, out, jobs, as_json=as_json)


@app.command()
def speeds(
    robot: options.Robot = "minibiped",
    sagittal: Annotated[
        list[float] | None,
        Option("--sagittal", "-s", help="Speed in m/s; repeatable.", show_default="scaled"),
    ] = None,
    coronal: Annotated[
        list[float] | None,
        Option("--coronal", "-c", help="Speed in m/s, left positive; repeatable."),
    ] = None,
    duration: Annotated[float, Option(help="Walking time at each speed in s.")] = 20.0,
    steps: study_options.Steps = None,
    backend: study_options.Backend = None,
    rate: options.Rate = None,
    pd: options.Pd = None,
    estimator: options.Estimator = None,
    stabilizer: study_options.Stabilizer = None,
    ankle_limit: options.AnkleLimit = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Reached speed over a grid of sagittal and coronal speeds."""
    from hil.studies.speeds import SpeedStudy, default_speeds

    request = resolved_request(
        robot, None, overrides, backend=backend, rate_hz=rate, pd=pd, estimator=estimator,
        stabilizer=stabilizer, ankle_limit=ankle_limit, seed=seed,
    )  # fmt: skip
    across, along = default_speeds(request)
    study = checked(
        SpeedStudy,
        request=request,
        sagittal=tuple(sagittal or along)[: 2 if quick else None],
        coronal=tuple(coronal or across)[: 1 if quick else None],
        duration_s=3.0 if quick else duration,
        steps=None if quick else steps,
    )
    conduct(study, out, jobs, as_json=as_json)


@app.command()
def turns(
    robot: options.Robot = "minibiped",
    angle: Annotated[list[float] | None, Option(help="Degrees, left positive; repeatable.")] = None,
    turn_rate: Annotated[
        list[float] | None,
        Option(help="rad/s, 0 for at once; repeatable.", show_default="1; 0 for torque robots"),
    ] = None,
    rate: Annotated[
        list[int] | None,
        Option("--rate", "-r", help="Control rate in Hz; repeatable.", show_default="robot's"),
    ] = None,
    pd: Annotated[
        list[str] | None, Option(help="Of a torque robot; repeatable.", show_default="both")
    ] = None,
    settle: Annotated[float, Option(help="Walking time before the turn in s.")] = 5.0,
    duration_after: Annotated[float, Option(help="Time from the turn's begin in s.")] = 8.0,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    estimator: options.Estimator = None,
    stabilizer: study_options.Stabilizer = None,
    ankle_limit: options.AnkleLimit = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Turns while walking: time to 95 %, overshoot, final error."""
    from hil.studies.turns import TurnStudy

    request = resolved_request(
        robot, speed, overrides, backend=backend, estimator=estimator,
        stabilizer=stabilizer, ankle_limit=ankle_limit, seed=seed,
        rate_hz=rate[0] if rate else None, pd=pd[0] if pd else None,
    )  # fmt: skip
    torque = request.pd is not None
    angles = tuple(angle or (45.0, 90.0, 115.0, 150.0, 180.0))
    pds = tuple(pd or ("explicit", "implicit")) if torque else (None,)
    study = checked(
        TurnStudy,
        request=request,
        angles_deg=angles[:1] if quick else angles,
        turn_rates=tuple(turn_rate or ((0.0,) if torque else (1.0,))),
        rates_hz=tuple(rate or (request.rate_hz,)),
        pds=pds[:1] if quick else pds,
        settle_s=2.0 if quick else settle,
        follow_s=3.0 if quick else duration_after,
    )
    conduct(study, out, jobs, as_json=as_json)


@app.command()
def rates(
    robot: options.Robot = "minibiped",
    rate: Annotated[
        list[int] | None,
        Option("--rate", "-r", help="Control rate in Hz; repeatable.", show_default="2000 … 30"),
    ] = None,
    pd: Annotated[
        list[str] | None, Option(help="Of a torque robot; repeatable.", show_default="both")
    ] = None,
    scenario: Annotated[
        list[str] | None, Option(help="straight, cycle, pushed; repeatable.", show_default="all")
    ] = None,
    duration: Annotated[float, Option(help="Walking time in s.")] = 20.0,
    steps: study_options.Steps = None,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    estimator: options.Estimator = None,
    stabilizer: study_options.Stabilizer = None,
    ankle_limit: options.AnkleLimit = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """Control rates that walk: straight, with the coronal cycle, pushed; with h·√(g/L)."""
    from hil.studies.rates import RATES_HZ, SCENARIOS, RateStudy

    request = resolved_request(
        robot, speed, overrides, backend=backend, estimator=estimator,
        stabilizer=stabilizer, ankle_limit=ankle_limit, seed=seed, pd=pd[0] if pd else None,
    )  # fmt: skip
    pds = tuple(pd or ("explicit", "implicit")) if request.pd is not None else (None,)
    study = checked(
        RateStudy,
        request=request,
        rates_hz=tuple(rate or ((300, 60) if quick else RATES_HZ)),
        pds=pds[:1] if quick else pds,
        scenarios=tuple(scenario or SCENARIOS),
        duration_s=4.0 if quick else duration,
        steps=None if quick else steps,
    )
    conduct(study, out, jobs, as_json=as_json)
