"""`stride walk`: one walk, from the command line to its run folder."""

from typing import Any

from hil.cli import options
from hil.cli.bringup_options import Ports, PortsFile, Yes
from hil.cli.rungs import conduct, live_ports
from hil.fault_spec import gather_faults
from hil.request import RunRequest
from hil.schedule import parse_ball, parse_point, parse_push, parse_turn

EPILOG = """[bold]Examples[/bold]

stride walk                                       a dry run of the small biped, 20 s

stride walk --backend mujoco --speed 0 --speed 0.3@10    from 0 to 0.3 m/s in 10 s

stride walk --turn 90@5 --push 0,3,0@8+0.3        a left turn, then a push from the right

stride walk --fault servo:left_knee:silent@5+0.01    a servo silent for 10 ms (docs/faults.md)

stride walk --realtime --duration 30              in real time, on pseudo-terminals

stride walk --hoisted                             in the air: the rung before the ground

stride walk my_robot.yaml --live --hoisted        a real robot, hung up; docs/bring-up.md

stride walk --view web                            watched and steered in a browser

stride walk --steer keys                          steered with the arrow keys

stride walk human --rate 300 --duration 60        the seeds' character, on MuJoCo

stride walk human --water 0 --water 0.5@10        water that rises to the knees in 10 s
"""


WALK_S, STEERED_S = 20.0, 600.0
"""Walking time where none is asked for; somebody who steers ends the walk himself."""


def walk(
    robot: options.Robot = "minibiped",
    backend: options.Backend = None,
    bus: options.Bus = None,
    live: options.Live = False,
    hoisted: options.Hoisted = False,
    port: Ports = None,
    ports: PortsFile = None,
    yes: Yes = False,
    rate: options.Rate = None,
    duration: options.WalkTime = None,
    seed: options.Seed = 0,
    realtime: options.Realtime = False,
    priority: options.Priority = None,
    speed: options.Speed = None,
    lateral: options.Lateral = None,
    turn: options.Turn = None,
    step_width: options.StepWidth = None,
    push: options.Push = None,
    ball: options.Ball = None,
    water: options.Water = None,
    density: options.Density = None,
    viscosity: options.Viscosity = None,
    fault: options.Faults = None,
    fault_plan: options.FaultPlan = None,
    estimator: options.Estimator = None,
    pd: options.Pd = None,
    stabilizer: options.Stabilizer = None,
    stabilizer_solver: options.StabilizerSolver = None,
    ankle_limit: options.AnkleLimit = None,
    view: options.View = None,
    steer: options.Steer = None,
    overrides: options.Overrides = None,
    out: options.Out = None,
    report: options.Report = None,
    as_json: options.Json = False,
) -> None:
    """Walk, and leave a run folder: meta.json, session.mcap, report.json, picture.png.

    T = 0 is the first walking tick. A real robot is asked for with --live: the command asks before
    torque goes on, and walks on the ground only after a passed hoisted walk with this calibration.
    Exit code 0: walked to the end; 1: fell or had to stop; 2: bad input, nothing was started.
    """
    changes = tuple(overrides or ())
    body = {"robot": robot, "backend": backend, "bus": bus, "live": live, "hoisted": hoisted}
    steered = {"view": view, "steer": steer}
    silent = STEERED_S if view or steer else WALK_S
    time_s = silent if duration is None else duration
    clock = {"rate_hz": rate, "duration_s": time_s, "realtime": realtime, "priority": priority}
    law = {"estimator": estimator, "pd": pd, "ankle_limit": ankle_limit, "seed": seed}
    steady = {"stabilizer": stabilizer, "stabilizer_solver": stabilizer_solver}
    files = {"overrides": changes, "out": out, "report": report}
    course = _schedules(speed, lateral, turn, push, ball) | _liquid(water, density, viscosity)
    request = RunRequest.checked(
        **(body | clock | law | steady | steered | files),
        ports=live_ports(robot, changes, port, ports),
        schedules=course | {"step_width": step_width},
        faults=gather_faults(fault or (), fault_plan),
    )
    conduct(request, yes=yes, as_json=as_json)


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


def _liquid(
    water: list[str] | None, density: list[str] | None, viscosity: list[str] | None
) -> dict[str, Any]:
    return {
        "water": tuple(parse_point("--water", text) for text in water or ()),
        "density": tuple(parse_point("--density", text) for text in density or ()),
        "viscosity": tuple(parse_point("--viscosity", text) for text in viscosity or ()),
    }
