"""`stride plot`: the picture of a run, drawn again from its recording."""

import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

EPILOG = """[bold]Example[/bold]

stride plot runs/20260101-120000-minibiped --out walk.pdf
"""


def plot(
    run: Annotated[Path, Argument(help="A run folder.")],
    out: Annotated[
        Path | None, Option(help="PNG, SVG or PDF file.", show_default="picture.png in the run")
    ] = None,
) -> None:
    """Draw a run's picture from its recording, even if the run was killed."""
    from hil.errors import InputError
    from hil.figures import draw_run
    from hil.recording import read_recording
    from hil.robot_files import load_robot

    recording = read_recording(run)
    trace = recording.trace()
    if len(trace) < 2:
        raise InputError(f"{run}: the recording ends before the first walking tick")
    path = out or run / "picture.png"
    try:
        draw_run(trace, load_robot(recording.meta["description"]), recording.meta, path)
    except (OSError, ValueError) as error:
        raise InputError(f"--out {path}: {error}") from error
    sys.stdout.write(f"{path}\n")
