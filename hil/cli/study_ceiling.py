"""`stride study ceiling`: the closed-form ceiling of gains."""

from pathlib import Path
from typing import Annotated

from typer import Option

from hil.cli import options, study_options
from hil.cli.study_conduct import checked, conduct, resolved_request
from hil.errors import InputError


def ceiling(
    robot: options.Robot = "human",
    rate: Annotated[
        list[int] | None,
        Option("--rate", "-r", help="Control rate in Hz; repeatable.", show_default="of all sets"),
    ] = None,
    found: Annotated[
        Path | None,
        Option("--range", help="CSV of `study gains`: judge its largest sets, draw its ranges."),
    ] = None,
    poses: Annotated[int, Option(help="Poses of two strides.", min=2)] = 48,
    check: Annotated[
        bool, Option("--check/--no-check", help="Walk below and above each ceiling.")
    ] = True,
    duration: Annotated[float, Option(help="Length of each walk in s.")] = 4.0,
    speed: study_options.Speed = None,
    backend: study_options.Backend = None,
    estimator: options.Estimator = None,
    seed: options.Seed = 0,
    overrides: options.Overrides = None,
    jobs: study_options.Jobs = None,
    scheduler: study_options.Scheduler = None,
    out: study_options.Out = None,
    quick: study_options.Quick = False,
    as_json: study_options.Json = False,
) -> None:
    """How high gains may be: h·λ_max(M⁻¹D) ≤ 2 from the model, and walks on both sides of it."""
    from hil.robot_files import load_robot
    from hil.studies.ceiling import CeilingStudy
    from hil.studies.gain_sets import stored_sets
    from hil.studies.range_file import read_ranges

    request = resolved_request(
        robot, speed, overrides, backend=backend, estimator=estimator, seed=seed,
    )  # fmt: skip
    if found is not None and rate:
        raise InputError("--rate: the rates are those of the --range file")
    ranges = read_ranges(found) if found is not None else ()
    stored = sorted(stored_sets(load_robot(robot, request.overrides)), reverse=True)
    study = checked(
        CeilingStudy,
        request=request,
        rates_hz=tuple(one.rate_hz for one in ranges)
        or tuple(rate or stored)[: 1 if quick else None],
        ranges=ranges,
        poses=4 if quick else poses,
        walk_s=duration,
        check=check and not quick,
    )
    conduct(study, out, jobs, as_json=as_json, scheduler=scheduler)
