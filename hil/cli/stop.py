"""`stride stop`: the software stop of a run, from another terminal."""

import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from hil.errors import InputError
from hil.stop_listener import SOCKET, ask_to_stop

EPILOG = """[bold]Examples[/bold]

stride stop                       the run under runs/ that listens: torque off now

stride stop runs/20261122-101500-minibiped --sit    sit down first

echo off | nc -U runs/20261122-101500-minibiped/stop    the same without this program
"""


def stop(
    run: Annotated[
        Path | None,
        Argument(metavar="[RUN]", help="Run folder; without it, the newest that listens."),
    ] = None,
    sit: Annotated[bool, Option("--sit", help="Sit down first, then torque off.")] = False,
) -> None:
    """Stop a run that is going on: torque off now, as the space key of its terminal does.

    This is a software stop. Only the switch in the servo supply is an emergency stop. Exit code
    0: the run has heard it; 2: no run listens there.
    """
    word = "sit" if sit else "off"
    folders = [run] if run is not None else _listening()
    for folder in folders:
        try:
            ask_to_stop(folder, word)
        except OSError:
            continue  # Left over by a run that was killed.
        sys.stdout.write(f"{folder}: {word} was heard\n")
        return
    where = str(run) if run is not None else "runs/"
    raise InputError(f"no run listens in {where}: cut the servo power if the robot moves")


def _listening() -> list[Path]:
    """Run folders with a socket, the newest first."""
    return [path.parent for path in sorted(Path("runs").glob(f"*/{SOCKET}"), reverse=True)]
