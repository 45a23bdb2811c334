"""`stride stand`: torque on, to the standing pose, and down again."""

from hil.cli import options
from hil.cli.bringup_options import Ports, PortsFile, Yes
from hil.cli.rungs import conduct, live_ports
from hil.request import RunRequest

EPILOG = """[bold]Examples[/bold]

stride stand                          a dry run of the small biped, 10 s

stride stand --set hoist=true         the same, hung up by its torso

stride stand my_robot.yaml --live     a real robot, on the gantry
"""


def stand(
    robot: options.Robot = "minibiped",
    backend: options.Backend = None,
    bus: options.Bus = None,
    live: options.Live = False,
    port: Ports = None,
    ports: PortsFile = None,
    yes: Yes = False,
    rate: options.Rate = None,
    duration: options.StandTime = 10.0,
    seed: options.Seed = 0,
    realtime: options.Realtime = False,
    priority: options.Priority = None,
    fault: options.Faults = None,
    view: options.View = None,
    overrides: options.Overrides = None,
    out: options.Out = None,
    report: options.Report = None,
    as_json: options.Json = False,
) -> None:
    """Hold the present pose, move slowly to the standing one, stand, sit down, torque off.

    Nothing balances: joints hold a pose. Ctrl-C sits down sooner. The run folder is a walk's.
    Exit code 0: stood to the end; 1: had to stop; 2: bad input, nothing was started.
    """
    from hil.fault_spec import gather_faults

    changes = tuple(overrides or ())
    request = RunRequest.checked(
        robot=robot,
        activity="stand",
        backend=backend,
        bus=bus,
        live=live,
        ports=live_ports(robot, changes, port, ports),
        rate_hz=rate,
        duration_s=duration,
        seed=seed,
        realtime=realtime,
        priority=priority,
        schedules={"speed": ((0.0, 0.0),)},
        faults=gather_faults(fault or (), None),
        view=view,
        overrides=changes,
        out=out,
        report=report,
    )
    conduct(request, yes=yes, as_json=as_json)
