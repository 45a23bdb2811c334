"""Options that the bring-up commands share."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from hil.cli.completion import robots

Robot = Annotated[str, Argument(help="A robot that ships, or a YAML file.", autocompletion=robots)]
Ports = Annotated[
    list[str] | None,
    Option(
        "--port",
        metavar="NAME=DEVICE",
        help="Port of a bus or board, instead of the robot file's; repeatable.",
    ),
]
PortsFile = Annotated[
    Path | None,
    Option("--ports", metavar="FILE.json", help="Ports as [bold]stride emulate --json[/] prints."),
]
Yes = Annotated[bool, Option("--yes", help="Say yes to what the command asks.")]
