"""`stride sit`: from wherever it is to bent legs, then torque off."""

from hil.cli import options
from hil.cli.bringup_options import Ports, PortsFile, Yes
from hil.cli.rungs import conduct, live_ports
from hil.request import RunRequest

EPILOG = """[bold]Examples[/bold]

stride sit                            a dry run of the small biped, from standing

stride sit my_robot.yaml --live       a real robot, limp or stiff
"""
REST_S = 0.5
"""Time for which it sits before it is let go."""


def sit(
    robot: options.Robot = "minibiped",
    backend: options.Backend = None,
    bus: options.Bus = None,
    live: options.Live = False,
    port: Ports = None,
    ports: PortsFile = None,
    yes: Yes = False,
    rate: options.Rate = None,
    seed: options.Seed = 0,
    realtime: options.Realtime = False,
    priority: options.Priority = None,
    view: options.View = None,
    overrides: options.Overrides = None,
    out: options.Out = None,
    report: options.Report = None,
    as_json: options.Json = False,
) -> None:
    """Hold the present pose, move slowly to the sitting one, torque off, read back.

    Also for a robot that a dead program left stiff: it is taken over where it stands.
    Exit code 0: sat down; 1: had to stop; 2: bad input, nothing was started.
    """
    changes = tuple(overrides or ())
    request = RunRequest.checked(
        robot=robot,
        activity="sit",
        backend=backend,
        bus=bus,
        live=live,
        ports=live_ports(robot, changes, port, ports),
        rate_hz=rate,
        duration_s=REST_S,
        seed=seed,
        realtime=realtime,
        priority=priority,
        schedules={"speed": ((0.0, 0.0),)},
        view=view,
        overrides=changes,
        out=out,
        report=report,
    )
    conduct(request, yes=yes, as_json=as_json)
