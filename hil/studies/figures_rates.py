"""The figure of `stride study rates`: how long each rate walked."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import LEFT, STYLE, WARNING
from hil.studies.study import Result


def draw_rates(title: str, rows: list[Result], duration_s: float, length: str, path: Path) -> None:
    """A row a law and scenario: dots walked to the end, crosses fell, lower for sooner.

    Dots are at `duration_s`; `length` is how the title calls a whole walk.
    """
    kinds = list(dict.fromkeys(map(_kind, rows)))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 0.8 + 0.75 * len(kinds)), layout="constrained")
        first = None
        for place, kind in enumerate(kinds, start=1):
            axes = figure.add_subplot(len(kinds), 1, place, sharex=first)
            first = first or axes
            of_kind = [row for row in rows if _kind(row) == kind]
            for row in of_kind:
                period, end = row["period_froude"], row["stopped_s"]
                if row["error"]:
                    end = 0.0
                marker, colour = ("o", LEFT) if end is None else ("x", WARNING)
                time_s = duration_s if end is None else end
                axes.plot([period], [time_s], marker=marker, color=colour)
            axes.set(xscale="log", ylim=(-0.1 * duration_s, 1.2 * duration_s))
            axes.set_ylabel(kind, rotation=0, ha="right", va="center")
            axes.minorticks_off()
            labels = [f"{row['period_froude']:.4f}\n{row['rate_hz']} Hz" for row in of_kind]
            axes.set_xticks([row["period_froude"] for row in of_kind], labels)
            axes.tick_params(labelbottom=place == len(kinds))
        axes.set_xlabel("control period h·√(g/L) and rate")
        figure.suptitle(f"{title}: time walked, of {length}", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _kind(row: Result) -> str:
    return " ".join(filter(None, (row["pd"], row["scenario"])))
