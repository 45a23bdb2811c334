"""`stride walk`: one walk, from the command line to its run folder."""

import json
import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Exit, Option

from hil.cli.table import print_report
from hil.request import BackendName, BusName, EstimatorName, PdName, RunRequest
from hil.schedule import Schedules, parse_point, parse_push, parse_turn

EPILOG = """[bold]Examples[/bold]

stride walk                                       a dry run of the small biped, 20 s

stride walk --backend mujoco --speed 0 --speed 0.3@10    from 0 to 0.3 m/s in 10 s

stride walk --turn 90@5 --push 0,3,0@8+0.3        a left turn, then a push from the right

stride walk --realtime --duration 30              in real time, on pseudo-terminals

stride walk human --rate 300 --duration 60        the seeds' character, on MuJoCo
"""


def walk(
    robot: Annotated[str, Argument(help="A robot that ships, or a YAML file.")] = "minibiped",
    backend: Annotated[
        BackendName | None,
        Option(help="What stands behind the interface; the robot's own choice if not given."),
    ] = None,
    bus: Annotated[
        BusName | None, Option(help="With the bus backend: virtual servos, or real ones.")
    ] = None,
    live: Annotated[bool, Option("--live", help="Real servos may move.")] = False,
    rate: Annotated[int | None, Option(help="Control rate in Hz.", show_default="robot's")] = None,
    duration: Annotated[float, Option(help="Walking time in s.")] = 20.0,
    seed: Annotated[int, Option(help="Draws sensor noise, biases and latency jitter.")] = 0,
    realtime: Annotated[
        bool, Option("--realtime", help="Pace a simulated robot by the clock on the wall.")
    ] = False,
    priority: Annotated[
        int | None, Option(help="SCHED_FIFO priority of the loop, with --realtime or --live.")
    ] = None,
    speed: Annotated[
        list[str] | None,
        Option(metavar="V[@T]", help="Speed in m/s, at a time in s; repeatable, linear between."),
    ] = None,
    lateral: Annotated[
        list[str] | None,
        Option(metavar="V[@T]", help="Sideways speed, left positive; repeatable as --speed."),
    ] = None,
    turn: Annotated[
        list[str] | None,
        Option(metavar="DEG@T", help="Turn from the present heading, left positive; repeatable."),
    ] = None,
    step_width: Annotated[
        float | None, Option(help="Lateral distance of the feet in m.", show_default="robot's")
    ] = None,
    push: Annotated[
        list[str] | None,
        Option(metavar="FX,FY,FZ@T+DT", help="World force in N on the torso; repeatable."),
    ] = None,
    estimator: Annotated[
        EstimatorName | None, Option(help="Sensors only, or the simulation's truth.")
    ] = None,
    pd: Annotated[PdName | None, Option(help="Integration of a torque robot's PD.")] = None,
    ankle_limit: Annotated[
        bool | None,
        Option("--ankle-limit/--no-ankle-limit", help="Limit ankle torque by the measured load."),
    ] = None,
    overrides: Annotated[
        list[str] | None,
        Option("--set", metavar="KEY=VALUE", help="Change a value of the robot file; repeatable."),
    ] = None,
    out: Annotated[
        Path | None, Option(help="The run folder itself.", show_default="runs/<time>-<robot>")
    ] = None,
    report: Annotated[Path | None, Option(help="A second copy of report.json.")] = None,
    as_json: Annotated[
        bool, Option("--json", help="Print the report as JSON; the run folder on stderr.")
    ] = False,
) -> None:
    """Walk, and leave a run folder: meta.json, session.mcap, report.json, picture.png.

    T = 0 is the first walking tick. Exit code 0: walked to the end; 1: fell or had to stop;
    2: bad input, nothing was started.
    """
    schedules = Schedules(
        speed=tuple(parse_point("--speed", text) for text in speed or ()),
        lateral=tuple(parse_point("--lateral", text) for text in lateral or ()),
        turns=tuple(parse_turn("--turn", text) for text in turn or ()),
        pushes=tuple(parse_push("--push", text) for text in push or ()),
    )
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
        schedules={**dict(schedules), "step_width": step_width},
        estimator=estimator,
        pd=pd,
        ankle_limit=ankle_limit,
        overrides=tuple(overrides or ()),
        out=out,
        report=report,
    )
    _run(request, as_json=as_json)


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
