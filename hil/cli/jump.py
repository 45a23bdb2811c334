"""`stride jump`: one jump, from the command line to its run folder."""

from typing import Annotated

from typer import Option

from hil.cli import options
from hil.cli.rungs import conduct
from hil.request import RunRequest

EPILOG = """[bold]Examples[/bold]

stride jump                                        0.3 m forward, the seeds' character

stride jump --target 0.4 0 0.15 --airtime 0.45     onto a step

stride jump --target 0 0 0 --airtime 0.9 --gravity 1.62    on the Moon

stride jump minibiped --target 0 0 0 --airtime 0.04    what its servos can do, in the dry run
"""

Target = Annotated[
    tuple[float, float, float],
    Option(metavar="X Y Z", help="Where the feet land from where they stand, in m."),
]
Airtime = Annotated[float, Option(help="Time in the air in s.")]
PushDepth = Annotated[
    float | None,
    Option(help="How far the body rises while the feet push, in m.", show_default="0.32 leg"),
]
Gravity = Annotated[float, Option(help="In m/s².")]
Duration = Annotated[float, Option(help="Time from the begin of the windup in s.")]


def jump(
    robot: options.Robot = "human",
    target: Target = (0.3, 0.0, 0.0),
    airtime: Airtime = 0.4,
    push_depth: PushDepth = None,
    gravity: Gravity = 9.81,
    backend: options.Backend = None,
    bus: options.Bus = None,
    rate: options.Rate = None,
    duration: Duration = 4.0,
    seed: options.Seed = 0,
    realtime: options.Realtime = False,
    priority: options.Priority = None,
    estimator: options.Estimator = None,
    overrides: options.Overrides = None,
    out: options.Out = None,
    report: options.Report = None,
    as_json: options.Json = False,
) -> None:
    """Crouch, push off, fly, land and stand; leave a run folder as `walk` does.

    A jump beyond the joints' torques or speeds is refused before anything moves, with the largest
    one that fits. Z other than 0 puts a step there; below 0 the robot starts on it.
    Exit code 0: at the end it stands still where it landed; 1: it does not (it fell, had to stop,
    never left the ground, or still moves); 2: bad input, nothing was started.
    """
    changes = tuple(overrides or ())
    if push_depth is None:
        from hil.compose import default_push_depth

        push_depth = default_push_depth(robot, changes)
    order = {"target": target, "airtime": airtime, "push_depth": push_depth, "gravity": gravity}
    request = RunRequest.checked(
        robot=robot,
        activity="jump",
        jump=order,
        backend=backend,
        bus=bus,
        rate_hz=rate,
        duration_s=duration,
        seed=seed,
        realtime=realtime,
        priority=priority,
        estimator=estimator,
        schedules={"speed": ((0.0, 0.0),)},
        overrides=changes,
        out=out,
        report=report,
    )
    conduct(request, yes=False, as_json=as_json)
