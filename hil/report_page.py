"""report.html: one run on one page, in one file that needs no network and no other file."""

import base64
from io import BytesIO
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from hil import __version__
from hil.errors import InputError
from hil.gait_report import gait_figures, percentiles_ms
from hil.plots.catalogue import PLOTS, draw_plot
from hil.plots.plotted_run import PlottedRun
from hil.report_words import ON_THE_GROUND, main_figures, number

FILES = ("report.json", "meta.json", "session.mcap", "picture.png")
"""What the page links to, where it lies beside it."""


def write_report_page(folder: Path, run: PlottedRun, path: Path) -> None:
    """Write the page of a run whose folder is `folder`. Raises InputError."""
    html = report_page(run, links=[name for name in FILES if (folder / name).is_file()])
    try:
        path.write_text(html, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error


def report_page(run: PlottedRun, links: list[str]) -> str:
    """The page as text: figures, faults, plots, settings."""
    environment = Environment(
        loader=PackageLoader("hil", "templates"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    report = known_figures(run)
    return environment.get_template("report.html").render(
        run=run,
        meta=run.meta,
        verdict=verdict(run),
        tiles=main_figures(report, on_the_ground=run.meta["rung"] in ON_THE_GROUND),
        faults=run.faults,
        plots=_plots(run),
        settings=settings(run.meta["request"]),
        report={key: _shown(value) for key, value in report.items() if key != "faults"},
        links=links,
        version=__version__,
    )


def known_figures(run: PlottedRun) -> dict[str, Any]:
    """report.json; of a run that was killed before it was written, what its recording says."""
    if run.report is not None:
        return run.report
    trace = run.trace
    return {
        **gait_figures(trace, run.meta["weight_n"]),
        **percentiles_ms("controller_ms", trace.control_ns),
        **percentiles_ms("cycle_ms", trace.cycle_ns),
    }


def verdict(run: PlottedRun) -> tuple[bool, str]:
    """Whether a run went to its end, and how it ended in a few words."""
    if run.report is None:
        how = "" if run.recording.complete else ", and the recording is cut off"
        return False, f"ended without a report{how}"
    ends = [fault for fault in run.faults if fault["reaction"] != "none"]
    if ends:
        first = ends[0]
        return False, f"{first['source']}: {first['name']} at {first['time_s']:.2f} s"
    return True, "went to its end"


def settings(request: dict[str, Any]) -> dict[str, str]:
    """What the run was asked for, without what was left open; nested keys have dots."""
    flat: dict[str, str] = {}
    for key, value in request.items():
        if isinstance(value, dict):
            flat |= {f"{key}.{name}": text for name, text in settings(value).items()}
        elif value is not None and value is not False and value not in ([], ""):
            flat[key] = _shown(value)
    return flat


def _plots(run: PlottedRun) -> list[dict[str, str]]:
    """Name, heading, caption and picture, as a data URL, of every plot that applies."""
    shown = []
    for name, plot in PLOTS.items():
        if plot.applies(run):
            stream = BytesIO()
            draw_plot(name, run, stream)
            data = "data:image/png;base64," + base64.b64encode(stream.getvalue()).decode()
            shown.append(
                {"name": name, "heading": plot.heading, "caption": plot.caption, "data": data}
            )
    return shown


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(map(_shown, value))
    return number(value) if isinstance(value, bool) or value is None else f"{value}"
