"""Options that all studies take."""

from pathlib import Path
from typing import Annotated

from typer import Option

from hil.request import BackendName

Backend = Annotated[
    BackendName | None,
    Option(help="MuJoCo, or the dry run on a virtual bus; the robot's own choice if not given."),
]
Speed = Annotated[float | None, Option(help="Sagittal speed in m/s.", show_default="robot's")]
Stabilizer = Annotated[
    bool | None, Option("--stabilizer/--no-stabilizer", help="Ground contact stabilizer.")
]
Steps = Annotated[
    int | None, Option(help="Length of each walk in steps.", show_default="--duration", min=10)
]
Jobs = Annotated[int | None, Option(help="Worker processes.", show_default="one a CPU")]
Scheduler = Annotated[
    str | None,
    Option(metavar="tcp://HOST:PORT", help="Run on the workers of this Dask scheduler instead."),
]
Out = Annotated[
    Path | None,
    Option(help="The study's folder; an interrupted study goes on there.",
           show_default="studies/<study>-<robot>"),
]  # fmt: skip
Quick = Annotated[bool, Option("--quick", help="A few short walks: does it run at all?")]
Json = Annotated[
    bool, Option("--json", help="Print the cases as JSON; the study's folder on stderr.")
]
