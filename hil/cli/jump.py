"""`stride jump`: one jump, from the command line to its run folder."""

import math
from typing import Annotated

from typer import Option

from hil.cli import options
from hil.cli.rungs import conduct
from hil.interface import GRAVITY
from hil.request import RunRequest

EPILOG = """[bold]Examples[/bold]

stride jump                                        0.3 m forward, the seeds' character

stride jump --target 0.4 0 0.15 --airtime 0.45     onto a step

stride jump --target 0 0 0 --airtime 0.9 --gravity 1.62    on the Moon

stride jump --run-up 0.5                           walk, jump, walk on

stride jump minibiped --target 0 0 0 --airtime 0.09 --set supply.voltage=14.8    a hop of servos
"""

Target = Annotated[
    tuple[float, float, float],
    Option(metavar="X Y Z", help="Where the feet land from where they stand, in m."),
]
Airtime = Annotated[float, Option(help="Time in the air in s.")]
PushDepth = Annotated[
    float | None,
    Option(
        help="How far the body rises while the feet push, in m.",
        show_default="0.32 leg; servos 0.16",
    ),
]
Gravity = Annotated[float, Option(help="In m/s².")]
RunUp = Annotated[
    float | None,
    Option(help="Walk before and after, at this speed in m/s.", show_default="stands"),
]
Duration = Annotated[
    float | None,
    Option(help="In s, with run-up.", show_default="4 on Earth; 13 with --run-up"),
]
ON_EARTH_S, WITH_RUN_UP_S = 4.0, 13.0
"""Time for all stages of a jump, which goes with 1/√g, and with a walk before and after it."""


def jump(
    robot: options.Robot = "human",
    target: Target = (0.3, 0.0, 0.0),
    airtime: Airtime = 0.4,
    push_depth: PushDepth = None,
    gravity: Gravity = GRAVITY,
    backend: options.Backend = None,
    bus: options.Bus = None,
    rate: options.Rate = None,
    run_up: RunUp = None,
    duration: Duration = None,
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
    With --run-up it walks for 3 s, slows down over two or three steps, jumps, and walks on from
    where it landed, which needs level ground.
    Exit code 0: it came to stand still where it landed, and did not fall in a walk after that; 1:
    it did not (it fell, had to stop, never left the ground, or still moves at the end); 2: bad
    input, nothing was started.
    """
    changes = tuple(overrides or ())
    if push_depth is None:
        push_depth = _push_depth(robot, changes)
    order = {"target": target, "airtime": airtime, "push_depth": push_depth, "gravity": gravity}
    request = RunRequest.checked(
        robot=robot,
        activity="jump",
        jump=order | {"run_up": run_up},
        backend=backend,
        bus=bus,
        rate_hz=rate,
        duration_s=_duration(gravity, run_up) if duration is None else duration,
        seed=seed,
        realtime=realtime,
        priority=priority,
        estimator=estimator,
        schedules={"speed": ((0.0, run_up or 0.0),)},
        overrides=changes,
        out=out,
        report=report,
    )
    conduct(request, yes=False, as_json=as_json)


def _push_depth(robot: str, changes: tuple[str, ...]) -> float:
    from hil.compose import default_push_depth

    return default_push_depth(robot, changes)


def _duration(gravity: float, run_up: float | None) -> float:
    """Of a jump under a gravity [m/s²]; one that is refused later counts as the Earth's."""
    if run_up is not None:
        return WITH_RUN_UP_S
    return round(ON_EARTH_S * math.sqrt(GRAVITY / gravity), 1) if gravity > 0.0 else ON_EARTH_S
