"""`stride plot`: the pictures of a run, and its page, drawn from its recording."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

if TYPE_CHECKING:
    from hil.plots.plotted_run import PlottedRun

EPILOG = """[bold]Examples[/bold]

stride plot runs/20260101-120000-minibiped --html       everything on one page: report.html

stride plot runs/20260101-120000-minibiped --figure joints --out joints.pdf
"""
PICTURE = "walk"
"""The plot that every run has as picture.png."""


def plot(
    run: Annotated[Path, Argument(help="A run folder.")],
    html: Annotated[
        bool, Option("--html", help="Write report.html: figures, faults, every plot, settings.")
    ] = False,
    figure: Annotated[
        str | None,
        Option(
            metavar="NAME",
            help="One plot: walk, speed, gait, pressure, joints, torque, servos, timing, safety "
            "or water.",
            show_default="walk",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        Option(help="PNG, SVG or PDF file; with --html the page.", show_default="in the run"),
    ] = None,
) -> None:
    """Draw a run from its recording, even if the run was killed.

    Without options it is picture.png again; of a jump, whose picture is another, walk.png. The
    page of --html is one file that needs no network and no other file. See docs/reports.md.
    """
    from hil.errors import InputError
    from hil.plots.plotted_run import plotted_run
    from hil.report_page import write_report_page

    if html and figure is not None:
        raise InputError("--figure: --html has every plot in it; give one of the two")
    plotted = plotted_run(run)
    if html:
        path = out or run / "report.html"
        write_report_page(run, plotted, path)
    else:
        name = figure or PICTURE
        again = figure is None and not plotted.meta["rung"].endswith(", jump")
        path = out or run / ("picture.png" if again else f"{name}.png")
        _draw(plotted, name, path)
    sys.stdout.write(f"{path}\n")


def _draw(plotted: "PlottedRun", name: str, path: Path) -> None:
    from hil.errors import InputError, UnknownNameError
    from hil.plots.catalogue import PLOTS, draw_plot

    if name not in PLOTS:
        raise UnknownNameError("plot", name, PLOTS)
    if not PLOTS[name].applies(plotted):
        what = "a walk" if not plotted.walked else "anything for it"
        raise InputError(f"{plotted.name}: --figure {name}: the recording does not hold {what}")
    try:
        draw_plot(name, plotted, path, dpi=130)
    except (OSError, ValueError) as error:
        raise InputError(f"--out {path}: {error}") from error
