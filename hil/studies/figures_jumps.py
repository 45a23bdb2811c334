"""The figure of `stride study jumps`: targets from above, one panel a height and airtime."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import BODY, LIMIT, RIGHT, STYLE, WARNING
from hil.studies.study import Result

MARKS = (
    ("stands on target", "o", RIGHT),
    ("stands, off target", "s", BODY),
    ("fell", "x", WARNING),
    ("refused", ".", LIMIT),
)


def draw_jumps(title: str, rows: list[Result], path: Path) -> None:
    """Every target with what became of the jump, and the landing error in millimetres."""
    heights = sorted({row["z_m"] for row in rows}, reverse=True)
    airtimes = sorted({row["airtime_asked_s"] for row in rows})
    with mpl.rc_context(STYLE):
        size = (1.0 + 3.4 * len(airtimes), 0.9 + 2.3 * len(heights))
        figure = Figure(figsize=size, layout="constrained")
        panels = np.atleast_2d(
            figure.subplots(len(heights), len(airtimes), sharex=True, sharey=True, squeeze=False)
        )
        for line, z in zip(panels, heights, strict=True):
            for axes, airtime in zip(line, airtimes, strict=True):
                chosen = [r for r in rows if r["z_m"] == z and r["airtime_asked_s"] == airtime]
                _panel(axes, chosen)
                axes.set_title(f"{z:+.2f} m, {airtime:g} s" if z else f"level, {airtime:g} s")
            line[0].set_ylabel("left [m]")
        for axes in panels[-1]:
            axes.set_xlabel("forward [m]")
        handles = [
            mpl.lines.Line2D([], [], linestyle="none", marker=mark, color=colour, label=label)
            for label, mark, colour in MARKS
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=len(MARKS))
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=110)


def _panel(axes: Axes, rows: list[Result]) -> None:
    for row in rows:
        _, mark, colour = MARKS[_kind(row)]
        axes.plot(row["x_m"], row["y_m"], linestyle="none", marker=mark, color=colour)
        if row["landing_error_m"] is not None:
            axes.annotate(
                f"{1000 * row['landing_error_m']:.0f}",
                (row["x_m"], row["y_m"]),
                xytext=(0, 6),
                textcoords="offset points",
                ha="center",
                fontsize=7,
                color=LIMIT,
            )
    axes.margins(0.12, 0.25)


def _kind(row: Result) -> int:
    if not row["feasible"]:
        return 3
    if not row["landed_standing"]:
        return 2
    return 0 if row["on_target"] else 1
