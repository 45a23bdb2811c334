"""Options that more than one command takes, and the long list of `walk`."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from hil.cli.completion import robots
from hil.request import BackendName, BusName, EstimatorName, PdName, StabilizerSolverName, ViewName

Robot = Annotated[str, Argument(help="A robot that ships, or a YAML file.", autocompletion=robots)]
Backend = Annotated[
    BackendName | None,
    Option(help="What stands behind the interface; the robot's own choice if not given."),
]
Bus = Annotated[BusName | None, Option(help="With the bus backend: virtual servos, or real ones.")]
Live = Annotated[bool, Option("--live", help="The real robot: its servos move.")]
Hoisted = Annotated[
    bool, Option("--hoisted", help="Walk in the air: it hangs, and steps by the clock.")
]
Rate = Annotated[int | None, Option(help="Control rate in Hz.", show_default="robot's")]
Duration = Annotated[float, Option(help="Walking time in s.")]
StandTime = Annotated[float, Option("--duration", help="Standing time in s.")]
Seed = Annotated[int, Option(help="Draws sensor noise, biases and latency jitter.")]
Realtime = Annotated[
    bool, Option("--realtime", help="Pace a simulated robot by the clock on the wall.")
]
Priority = Annotated[
    int | None, Option(help="SCHED_FIFO priority of the loop, with --realtime or --live.")
]
Speed = Annotated[
    list[str] | None,
    Option(metavar="V[@T]", help="Speed in m/s, at a time in s; repeatable, linear between."),
]
Lateral = Annotated[
    list[str] | None,
    Option(metavar="V[@T]", help="Sideways speed, left positive; repeatable as --speed."),
]
Turn = Annotated[
    list[str] | None,
    Option(metavar="DEG@T", help="Turn from the present heading, left positive; repeatable."),
]
StepWidth = Annotated[
    float | None, Option(help="Lateral distance of the feet in m.", show_default="robot's")
]
Push = Annotated[
    list[str] | None,
    Option(metavar="FX,FY,FZ@T+DT", help="World force in N on the torso; repeatable."),
]
Ball = Annotated[
    list[str] | None,
    Option(metavar="KG,VX,VY,VZ@T", help="Ball thrown at the trunk, m/s at impact; repeatable."),
]
Water = Annotated[
    list[str] | None,
    Option(metavar="H[@T]", help="Level of a liquid in m above the floor; repeatable as --speed."),
]
Density = Annotated[
    list[str] | None,
    Option(metavar="R[@T]", help="Its density in kg/m³; repeatable.", show_default="1000"),
]
Viscosity = Annotated[
    list[str] | None,
    Option(metavar="MU[@T]", help="Factor on its drag; repeatable.", show_default="1"),
]
Faults = Annotated[
    list[str] | None,
    Option(
        "--fault",
        metavar="PLANE:NAME:KIND[=V][@T[+DT]]",
        help="Something goes wrong in a virtual robot (docs/faults.md); repeatable.",
    ),
]
FaultPlan = Annotated[
    Path | None, Option(metavar="FILE.yaml", help="More faults, a list of texts under `faults`.")
]
Estimator = Annotated[EstimatorName | None, Option(help="Sensors only, or the simulation's truth.")]
Pd = Annotated[PdName | None, Option(help="Integration of a torque robot's PD.")]
Stabilizer = Annotated[
    bool | None,
    Option("--stabilizer/--no-stabilizer", help="Ground contact stabilizer of a torque robot."),
]
StabilizerSolver = Annotated[
    StabilizerSolverName | None,
    Option(help="Search of the stabilizer.", show_default="linear"),
]
AnkleLimit = Annotated[
    bool | None,
    Option("--ankle-limit/--no-ankle-limit", help="Limit ankle torque by the measured load."),
]
Overrides = Annotated[
    list[str] | None,
    Option("--set", metavar="KEY=VALUE", help="Change a value of the robot file; repeatable."),
]
View = Annotated[
    ViewName | None,
    Option(help="Show the run while it goes on, in a browser or a window (docs/view.md)."),
]
Steer = Annotated[
    str | None,
    Option(metavar="keys|DEVICE", help="Steer with the keys, or also a gamepad /dev/input/js0."),
]
WalkTime = Annotated[
    float | None,
    Option("--duration", help="Walking time in s.", show_default="20, or 600 if it is steered"),
]
Out = Annotated[
    Path | None, Option(help="The run folder itself.", show_default="runs/<time>-<robot>")
]
Report = Annotated[Path | None, Option(help="A second copy of report.json.")]
Json = Annotated[bool, Option("--json", help="Print the report as JSON; the run folder on stderr.")]
