"""`stride walk`: one walk, from the command line to its run folder."""

import json
import sys
from typing import Any

from typer import Exit

from hil.cli import options
from hil.cli.table import print_report
from hil.fault_spec import gather_faults
from hil.request import RunRequest
from hil.schedule import parse_ball, parse_point, parse_push, parse_turn

EPILOG = """[bold]Examples[/bold]

stride walk                                       a dry run of the small biped, 20 s

stride walk --backend mujoco --speed 0 --speed 0.3@10    from 0 to 0.3 m/s in 10 s

stride walk --turn 90@5 --push 0,3,0@8+0.3        a left turn, then a push from the right

stride walk --fault servo:left_knee:silent@5+0.01    a servo silent for 10 ms (docs/faults.md)

stride walk --realtime --duration 30              in real time, on pseudo-terminals

stride walk human --rate 300 --duration 60        the seeds' character, on MuJoCo
"""


def walk(
    robot: options.Robot = "minibiped",
    backend: options.Backend = None,
    bus: options.Bus = None,
    live: options.Live = False,
    rate: options.Rate = None,
    duration: options.Duration = 20.0,
    seed: options.Seed = 0,
    realtime: options.Realtime = False,
    priority: options.Priority = None,
    speed: options.Speed = None,
    lateral: options.Lateral = None,
    turn: options.Turn = None,
    step_width: options.StepWidth = None,
    push: options.Push = None,
    ball: options.Ball = None,
    fault: options.Faults = None,
    fault_plan: options.FaultPlan = None,
    estimator: options.Estimator = None,
    pd: options.Pd = None,
    stabilizer: options.Stabilizer = None,
    stabilizer_solver: options.StabilizerSolver = None,
    ankle_limit: options.AnkleLimit = None,
    overrides: options.Overrides = None,
    out: options.Out = None,
    report: options.Report = None,
    as_json: options.Json = False,
) -> None:
    """Walk, and leave a run folder: meta.json, session.mcap, report.json, picture.png.

    T = 0 is the first walking tick. Exit code 0: walked to the end; 1: fell or had to stop;
    2: bad input, nothing was started.
    """
    request = RunRequest.checked(
        robot=robot,
        backend=backend,
        bus=bus,
        live=live,
        rate_hz=rate,
        duration_s=duration,
        seed=seed,
        realtime=realtime,
        priority=priority,
        schedules=_schedules(speed, lateral, turn, push, ball) | {"step_width": step_width},
        faults=gather_faults(fault or (), fault_plan),
        estimator=estimator,
        pd=pd,
        stabilizer=stabilizer,
        stabilizer_solver=stabilizer_solver,
        ankle_limit=ankle_limit,
        overrides=tuple(overrides or ()),
        out=out,
        report=report,
    )
    _run(request, as_json=as_json)


def _schedules(
    speed: list[str] | None,
    lateral: list[str] | None,
    turn: list[str] | None,
    push: list[str] | None,
    ball: list[str] | None,
) -> dict[str, Any]:
    return {
        "speed": tuple(parse_point("--speed", text) for text in speed or ()),
        "lateral": tuple(parse_point("--lateral", text) for text in lateral or ()),
        "turns": tuple(parse_turn("--turn", text) for text in turn or ()),
        "pushes": tuple(parse_push("--push", text) for text in push or ()),
        "balls": tuple(parse_ball("--ball", text) for text in ball or ()),
    }


def _run(request: RunRequest, *, as_json: bool) -> None:
    """Parts that take long to import come last: a wrong option is answered at once."""
    from hil.compose import build
    from hil.run import run

    result = run(build(request))
    if as_json:
        sys.stdout.write(json.dumps(result.report, indent=2) + "\n")
        sys.stderr.write(f"{result.folder}\n")
    else:
        print_report(result.report)
        sys.stdout.write(f"{result.folder}\n")
    if any(fault["reaction"] != "none" for fault in result.report["faults"]):
        raise Exit(1)
