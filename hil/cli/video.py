"""`stride video`: a film of a recorded run."""

import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

EPILOG = """[bold]Examples[/bold]

stride video runs/20260101-120000-minibiped

stride video runs/live1 --from 12 --to 14 --slower 4    two seconds, four times as long
"""


def video(
    run: Annotated[Path, Argument(metavar="RUN", help="A run folder.")],
    out: Annotated[
        Path | None, Option(help="MP4, MKV or MOV file.", show_default="RUN/video.mp4")
    ] = None,
    size: Annotated[str, Option(metavar="WxH", help="Picture in pixels.")] = "960x540",
    fps: Annotated[float, Option(min=1.0, max=120.0, help="Pictures a second.")] = 30.0,
    slower: Annotated[float, Option(min=0.1, max=100.0, help="How many times slower.")] = 1.0,
    begin: Annotated[
        float | None, Option("--from", help="Time of the run [s].", show_default="1 s before T = 0")
    ] = None,
    end: Annotated[
        float | None, Option("--to", help="Time of the run [s].", show_default="its end")
    ] = None,
) -> None:
    """Film a run from its recording: contact forces, centre of mass, support, foothold, water.

    Drawn off screen by EGL or OSMesa (MUJOCO_GL says which); needs the extra `video`. A real
    robot is drawn as its estimator saw it.
    """
    from hil.film.film import FilmPlan, film_run
    from hil.plots.plotted_run import plotted_run

    width, height = picture_size(size)
    plan = FilmPlan(width, height, fps, slower, begin, end)
    path = out or run / "video.mp4"
    film_run(plotted_run(run), plan, path, _tell)
    sys.stdout.write(f"{path}\n")


def picture_size(text: str) -> tuple[int, int]:
    """Width and height of `WxH`. Raises InputError."""
    from hil.errors import InputError

    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise InputError(f"--size {text}: is not WIDTHxHEIGHT, such as 960x540")
    pixels = int(width), int(height)
    if any(side % 2 or not 16 <= side <= 4096 for side in pixels):
        raise InputError(f"--size {text}: both sides must be even, from 16 to 4096")
    return pixels


def _tell(done: int, count: int) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\r{done} of {count} pictures" + ("\n" if done == count else ""))
